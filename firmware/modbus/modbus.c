#include "modbus/modbus.h"

#include "base/assert.h"

#include <string.h>

enum function {
    READ_COILS = 1,
    READ_DISCRETES = 2, /* inputs of one bit: the coils, which some panels read so */
    READ_HOLDINGS = 3,
    READ_INPUTS = 4,
    WRITE_COIL = 5,
    WRITE_HOLDING = 6,
    WRITE_COILS = 15,
    WRITE_HOLDINGS = 16,
    EXCHANGE = 23
};

#define EXCEPTION_FLAG 0x80
#define COIL_ON        0xFF00
#define COIL_OFF       0x0000

/* Function, address, quantity or value. */
#define SHORT_LENGTH 5
/* And the number of bytes that follow. */
#define LONG_LENGTH 6
/* Function, address and quantity to read, address and quantity to write, number of bytes. */
#define EXCHANGE_LENGTH 10

#define ADDRESSES 65536U

struct exchange {
    const struct modbus_map *map;
    const uint8_t *request;
    size_t length;
    uint8_t *reply;
};

/* Bytes that count bits or words take. */
static size_t data_bytes(enum modbus_table table, uint16_t count)
{
    return table == MODBUS_COILS ? (size_t)(count + 7) / 8 : (size_t)count * 2;
}

static enum modbus_exception check_range(uint16_t address, uint16_t count, uint16_t most)
{
    if (count < 1 || count > most)
        return MODBUS_VALUE;
    return (uint32_t)address + count > ADDRESSES ? MODBUS_ADDRESS : MODBUS_GOOD;
}

/* An exception is answered by the function with its top bit set, and the code. */
static size_t finish(const struct exchange *x, enum modbus_exception exception, size_t length)
{
    TAKT_ASSERT(exception != MODBUS_GOOD || length <= MODBUS_PDU_MAX);
    x->reply[0] = x->request[0];
    if (exception == MODBUS_GOOD)
        return length;
    x->reply[0] = (uint8_t)(x->request[0] | EXCEPTION_FLAG);
    x->reply[1] = (uint8_t)exception;
    return 2;
}

static size_t answer_read(const struct exchange *x, enum modbus_table table, uint16_t most)
{
    enum modbus_exception exception = MODBUS_VALUE;
    size_t bytes = 0;

    if (x->length == SHORT_LENGTH) {
        const uint16_t address = modbus_read16(x->request + 1);
        const uint16_t count = modbus_read16(x->request + 3);

        exception = check_range(address, count, most);
        bytes = data_bytes(table, count);
        if (exception == MODBUS_GOOD)
            exception = x->map->read(x->map->context, table, address, count, x->reply + 2);
    }
    x->reply[1] = (uint8_t)bytes;
    return finish(x, exception, 2 + bytes);
}

/* Functions 05 and 06: the reply is the request. */
static size_t answer_write_one(const struct exchange *x, enum modbus_table table)
{
    uint8_t data[2];
    uint16_t value;

    if (x->length != SHORT_LENGTH)
        return finish(x, MODBUS_VALUE, 0);
    memcpy(data, x->request + 3, sizeof data);
    value = modbus_read16(data);
    if (table == MODBUS_COILS) {
        if (value != COIL_ON && value != COIL_OFF)
            return finish(x, MODBUS_VALUE, 0);
        data[0] = value == COIL_ON;
    }
    memcpy(x->reply, x->request, SHORT_LENGTH);
    return finish(x, x->map->write(x->map->context, table, modbus_read16(x->request + 1), 1, data),
                  SHORT_LENGTH);
}

/* Functions 15 and 16: the reply repeats address and quantity. */
static size_t answer_write(const struct exchange *x, enum modbus_table table, uint16_t most)
{
    enum modbus_exception exception = MODBUS_VALUE;

    if (x->length > LONG_LENGTH) {
        const uint16_t address = modbus_read16(x->request + 1);
        const uint16_t count = modbus_read16(x->request + 3);
        const size_t bytes = x->request[5];

        exception = check_range(address, count, most);
        if (bytes != data_bytes(table, count) || x->length != LONG_LENGTH + bytes)
            exception = MODBUS_VALUE;
        if (exception == MODBUS_GOOD)
            exception =
                x->map->write(x->map->context, table, address, count, x->request + LONG_LENGTH);
        memcpy(x->reply, x->request, SHORT_LENGTH);
    }
    return finish(x, exception, SHORT_LENGTH);
}

/* Both ranges of function 23. */
static enum modbus_exception check_exchange(const struct exchange *x)
{
    const uint8_t *request = x->request;
    const uint16_t written = modbus_read16(request + 7);
    enum modbus_exception exception;

    if (request[9] != data_bytes(MODBUS_HOLDINGS, written) ||
        x->length != EXCHANGE_LENGTH + (size_t)request[9])
        return MODBUS_VALUE;
    exception =
        check_range(modbus_read16(request + 1), modbus_read16(request + 3), MODBUS_READ_WORDS_MAX);
    if (exception != MODBUS_GOOD)
        return exception;
    return check_range(modbus_read16(request + 5), written, MODBUS_EXCHANGE_WORDS_MAX);
}

/*
 * Function 23 writes first. What it reads is read once before, so that a range that cannot be read
 * is refused before anything is written.
 */
static size_t answer_exchange(const struct exchange *x)
{
    const struct modbus_map *map = x->map;
    const uint8_t *request = x->request;
    enum modbus_exception exception = MODBUS_VALUE;
    uint16_t count = 0;

    if (x->length > EXCHANGE_LENGTH)
        exception = check_exchange(x);
    if (exception == MODBUS_GOOD) {
        const uint16_t address = modbus_read16(request + 1);

        count = modbus_read16(request + 3);
        exception = map->read(map->context, MODBUS_HOLDINGS, address, count, x->reply + 2);
        if (exception == MODBUS_GOOD)
            exception = map->write(map->context, MODBUS_HOLDINGS, modbus_read16(request + 5),
                                   modbus_read16(request + 7), request + EXCHANGE_LENGTH);
        if (exception == MODBUS_GOOD)
            exception = map->read(map->context, MODBUS_HOLDINGS, address, count, x->reply + 2);
    }
    x->reply[1] = (uint8_t)data_bytes(MODBUS_HOLDINGS, count);
    return finish(x, exception, 2 + (size_t)x->reply[1]);
}

size_t takt_modbus_answer(const struct modbus_map *map, const uint8_t *request, size_t length,
                          uint8_t *reply)
{
    struct exchange x = {.map = map, .request = request, .length = length};

    x.reply = reply;
    switch (request[0]) {
    case READ_COILS:
    case READ_DISCRETES:
        return answer_read(&x, MODBUS_COILS, MODBUS_READ_BITS_MAX);
    case READ_HOLDINGS:
        return answer_read(&x, MODBUS_HOLDINGS, MODBUS_READ_WORDS_MAX);
    case READ_INPUTS:
        return answer_read(&x, MODBUS_INPUTS, MODBUS_READ_WORDS_MAX);
    case WRITE_COIL:
        return answer_write_one(&x, MODBUS_COILS);
    case WRITE_HOLDING:
        return answer_write_one(&x, MODBUS_HOLDINGS);
    case WRITE_COILS:
        return answer_write(&x, MODBUS_COILS, MODBUS_WRITE_BITS_MAX);
    case WRITE_HOLDINGS:
        return answer_write(&x, MODBUS_HOLDINGS, MODBUS_WRITE_WORDS_MAX);
    case EXCHANGE:
        return answer_exchange(&x);
    default:
        return finish(&x, MODBUS_FUNCTION, 0);
    }
}

size_t takt_modbus_request_length(const uint8_t *request, size_t length)
{
    if (length < 1)
        return 0;
    switch (request[0]) {
    case READ_COILS:
    case READ_DISCRETES:
    case READ_HOLDINGS:
    case READ_INPUTS:
    case WRITE_COIL:
    case WRITE_HOLDING:
        return SHORT_LENGTH;
    case WRITE_COILS:
    case WRITE_HOLDINGS:
        return length < LONG_LENGTH ? 0 : LONG_LENGTH + (size_t)request[5];
    case EXCHANGE:
        return length < EXCHANGE_LENGTH ? 0 : EXCHANGE_LENGTH + (size_t)request[9];
    default:
        return 0;
    }
}
