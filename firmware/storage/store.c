#include "storage/store.h"

#include "base/assert.h"
#include "base/crc32.h"
#include "storage/little_words.h"

#include <string.h>

#define MARK 0x31534B54U /* "TKS1" */

#define NO_SECTOR (-1)

/* Where the words of 32 bits of a head stand; the rest of it is blank. */
enum head_word { HEAD_MARK, HEAD_SEQUENCE, HEAD_SIZE, HEAD_CRC, HEAD_CHECK };

struct head {
    uint32_t sequence, size, crc;
};

static uint32_t crc_of(const uint8_t *bytes, size_t length)
{
    return takt_crc32_add(CRC32_START, bytes, length);
}

uint32_t takt_store_room(const struct store *store)
{
    TAKT_ASSERT(store->flash.sector_bytes > STORE_HEAD_BYTES);
    return store->flash.sector_bytes - STORE_HEAD_BYTES;
}

/* ---- what is there ---- */

#define HEAD_WORD_BYTES 4U

static const uint8_t *word_at(const uint8_t *sector, enum head_word word)
{
    return sector + (size_t)HEAD_WORD_BYTES * word;
}

static bool read_head(const struct store *store, unsigned sector, struct head *head)
{
    const uint8_t *at = store->flash.sector[sector];

    TAKT_ASSERT(sector < 2);
    *head = (struct head){.sequence = little_get32(word_at(at, HEAD_SEQUENCE)),
                          .size = little_get32(word_at(at, HEAD_SIZE)),
                          .crc = little_get32(word_at(at, HEAD_CRC))};
    return little_get32(word_at(at, HEAD_MARK)) == MARK &&
           little_get32(word_at(at, HEAD_CHECK)) ==
               crc_of(at, (size_t)HEAD_WORD_BYTES * HEAD_CHECK) &&
           head->size > 0 && head->size <= takt_store_room(store) &&
           head->crc == crc_of(at + STORE_HEAD_BYTES, head->size);
}

/* Sequences wrap: the later one is the one that is less than half the circle ahead. */
static bool is_later(uint32_t a, uint32_t b)
{
    return (int32_t)(a - b) > 0;
}

void takt_store_open(struct store *store, const struct flash_port *flash)
{
    struct head head;

    memset(store, 0, sizeof *store);
    store->flash = *flash;
    store->current = NO_SECTOR;
    for (unsigned i = 0; i < FLASH_SECTORS; i++) {
        if (!read_head(store, i, &head))
            continue;
        if (store->current == NO_SECTOR || is_later(head.sequence, store->sequence)) {
            store->current = (int)i;
            store->sequence = head.sequence;
            store->size = head.size;
        }
    }
}

bool takt_store_get(const struct store *store, const uint8_t **bytes, uint32_t *size)
{
    if (store->current == NO_SECTOR)
        return false;
    *bytes = store->flash.sector[store->current] + STORE_HEAD_BYTES;
    *size = store->size;
    return true;
}

/* ---- a new set ---- */

/* The sector that does not count. */
static unsigned other_sector(const struct store *store)
{
    return store->current == 0 ? 1 : 0;
}

static bool is_blank(const struct store *store, unsigned sector)
{
    const uint8_t *at = store->flash.sector[sector];

    TAKT_ASSERT(sector < 2);
    for (uint32_t i = 0; i < store->flash.sector_bytes; i++) {
        if (at[i] != 0xFF)
            return false;
    }
    return true;
}

static bool give_up(struct store *store)
{
    store->coming = 0;
    return false;
}

bool takt_store_begin(struct store *store, uint32_t size)
{
    const unsigned sector = other_sector(store);

    (void)give_up(store);
    if (size == 0 || size > takt_store_room(store))
        return false;
    if (!is_blank(store, sector) &&
        (!store->flash.erase(store->flash.context, sector) || !is_blank(store, sector)))
        return false;
    store->coming = size;
    store->written = 0;
    store->in_word = 0;
    return true;
}

static bool program_word(struct store *store)
{
    const bool good = store->flash.program(store->flash.context, other_sector(store),
                                           STORE_HEAD_BYTES + store->written, store->word, 1);

    TAKT_ASSERT(store->in_word > 0 && store->written < store->coming);
    store->written += store->in_word;
    store->in_word = 0;
    return good;
}

/* The last word is filled up as erased bytes are. */
static bool add_byte(struct store *store, uint8_t byte)
{
    TAKT_ASSERT(store->in_word < sizeof store->word);
    if (store->in_word == 0)
        memset(store->word, 0xFF, sizeof store->word);
    store->word[store->in_word++] = byte;
    if (store->in_word < FLASH_WORD_BYTES && store->written + store->in_word < store->coming)
        return true;
    return program_word(store);
}

bool takt_store_write(struct store *store, const uint8_t *bytes, size_t length)
{
    if (length > store->coming - store->written - store->in_word || store->coming == 0)
        return give_up(store);
    for (size_t i = 0; i < length; i++) {
        if (!add_byte(store, bytes[i]))
            return give_up(store);
    }
    return true;
}

const uint8_t *takt_store_look(const struct store *store)
{
    if (store->coming == 0 || store->written != store->coming)
        return NULL;
    return store->flash.sector[other_sector(store)] + STORE_HEAD_BYTES;
}

static void set_word(uint8_t *head, enum head_word word, uint32_t value)
{
    little_put32(head + (size_t)HEAD_WORD_BYTES * word, value);
}

void takt_store_make_head(const uint8_t *bytes, uint32_t size, uint32_t sequence,
                          uint8_t head[STORE_HEAD_BYTES])
{
    memset(head, 0xFF, STORE_HEAD_BYTES);
    set_word(head, HEAD_MARK, MARK);
    set_word(head, HEAD_SEQUENCE, sequence);
    set_word(head, HEAD_SIZE, size);
    set_word(head, HEAD_CRC, crc_of(bytes, size));
    set_word(head, HEAD_CHECK, crc_of(head, (size_t)HEAD_WORD_BYTES * HEAD_CHECK));
}

bool takt_store_commit(struct store *store)
{
    const uint8_t *bytes = takt_store_look(store);
    const unsigned sector = other_sector(store);
    uint8_t made[STORE_HEAD_BYTES];
    struct head head;

    if (bytes == NULL)
        return false;
    takt_store_make_head(bytes, store->coming, store->sequence + 1, made);
    if (!store->flash.program(store->flash.context, sector, 0, made, 1) ||
        !read_head(store, sector, &head))
        return give_up(store);
    store->current = (int)sector;
    store->sequence = head.sequence;
    store->size = head.size;
    store->coming = 0;
    return true;
}
