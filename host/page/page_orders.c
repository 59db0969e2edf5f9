#include "page/page_orders.h"

#include "base/maths.h"
#include "canopen/pdo.h"
#include "modbus/crc.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

/* Words before the bytes of a chunk: offset, length, check. */
#define CHUNK_HEAD_WORDS 4

static void write32(uint8_t *at, uint32_t value)
{
    modbus_write16(at, (uint16_t)(value >> 16));
    modbus_write16(at + 2, (uint16_t)value);
}

static const char *const reasons[] = {
    [PANEL_REFUSAL_NONE] = NULL,
    [PANEL_REFUSAL_STATE] = "not in this state",
    [PANEL_REFUSAL_LOCKED] = "the password is needed first",
    [PANEL_REFUSAL_CONTROL] = "another panel has control",
    [PANEL_REFUSAL_VALUE] = "the value is out of range",
    [PANEL_REFUSAL_ADDRESS] = "no such register",
    [PANEL_REFUSAL_BUSY] = "not taken at present: try again",
};

void page_client_open(struct page_client *client, unsigned number, struct panel_host *panel,
                      const struct page_setup *setup)
{
    *client = (struct page_client){.panel = panel, .setup = setup, .number = number, .watched = -1};
    client->map = panel_host_enter_page(panel, number);
}

void page_orders_reply(struct page_text *reply, double id, const char *refused)
{
    page_text_add(reply, "{\"reply\":%.0f,\"refused\":", id);
    page_text_add_string(reply, refused != NULL ? refused : "");
    page_text_add(reply, "}");
}

/* NULL: it is done; else why not. */
static const char *write_words(struct page_client *client, enum modbus_table table,
                               uint16_t address, uint16_t count, const uint8_t *data)
{
    if (client->map.write(client->map.context, table, address, count, data) == MODBUS_GOOD)
        return NULL;
    return reasons[panel_host_get_refusal(client->panel, client->number)];
}

static const char *write_number(struct page_client *client, enum panel_id id, double value)
{
    const struct panel_register *row = &takt_panel_registers[id];
    uint8_t data[4] = {0};

    if (value != takt_maths_floor(value) || value < (double)takt_panel_least(row) ||
        value > (double)panel_most(row) || (row->words == 1 && value > UINT16_MAX))
        return reasons[PANEL_REFUSAL_VALUE];
    if (row->table == MODBUS_COILS)
        data[0] = value != 0;
    else if (row->words == 1)
        modbus_write16(data, (uint16_t)(int64_t)value);
    else
        write32(data, (uint32_t)(int64_t)value);
    return write_words(client, row->table, row->address, row->words, data);
}

static const char *write_text(struct page_client *client, enum panel_id id, const char *text)
{
    const struct panel_register *row = &takt_panel_registers[id];
    const size_t length = strlen(text), room = (size_t)row->words * 2;
    uint8_t data[PANEL_MDI_MAX] = {0};

    if (row->form != PANEL_TEXT || room > sizeof data || length > room)
        return "the text is too long";
    for (size_t i = 0; i < length; i++)
        data[i] = (uint8_t)text[i];
    return write_words(client, row->table, row->address, row->words, data);
}

/* ["MODE",1] */
static const char *write_one(struct page_client *client, const cJSON *pair)
{
    const char *name = cJSON_GetStringValue(cJSON_GetArrayItem(pair, 0));
    const cJSON *value = cJSON_GetArrayItem(pair, 1);
    const enum panel_id id = name != NULL ? takt_panel_find_name(name) : REGISTER_COUNT;

    if (id == REGISTER_COUNT)
        return reasons[PANEL_REFUSAL_ADDRESS];
    if (cJSON_IsString(value))
        return write_text(client, id, value->valuestring);
    if (!cJSON_IsNumber(value) || takt_panel_registers[id].form >= PANEL_TEXT)
        return reasons[PANEL_REFUSAL_VALUE];
    return write_number(client, id, value->valuedouble);
}

static const char *write_all(struct page_client *client, const cJSON *pairs)
{
    const char *refused = NULL;
    const cJSON *pair;

    panel_host_lock(client->panel);
    cJSON_ArrayForEach(pair, pairs)
    {
        if (refused == NULL)
            refused = write_one(client, pair);
    }
    panel_host_unlock(client->panel);
    return refused;
}

static double number_of(const cJSON *array, int index)
{
    const cJSON *item = cJSON_GetArrayItem(array, index);

    return cJSON_IsNumber(item) ? item->valuedouble : -1;
}

static const char *begin_upload(struct page_client *client, const cJSON *upload)
{
    const char *refused;

    client->upload_at = 0;
    panel_host_lock(client->panel);
    refused = write_number(client, REGISTER_UPLOAD_KIND, PANEL_UPLOAD_PROGRAM);
    if (refused == NULL)
        refused = write_number(client, REGISTER_UPLOAD_SIZE, number_of(upload, 0));
    if (refused == NULL)
        refused = write_number(client, REGISTER_UPLOAD_CRC, number_of(upload, 1));
    if (refused == NULL)
        refused = write_number(client, REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_BEGIN);
    panel_host_unlock(client->panel);
    client->upload_problem = refused;
    return refused;
}

/* A request of the mailbox. */
static const char *write_chunk(struct page_client *client, const uint8_t *bytes, uint16_t length)
{
    uint8_t data[2 * CHUNK_HEAD_WORDS + PANEL_CHUNK_MAX] = {0};
    const uint16_t words = (uint16_t)(CHUNK_HEAD_WORDS + (length + 1) / 2);

    write32(data, client->upload_at);
    modbus_write16(data + 4, length);
    modbus_write16(data + 6, takt_crc16(bytes, length));
    memcpy(data + 2 * (size_t)CHUNK_HEAD_WORDS, bytes, length);
    return write_words(client, MODBUS_HOLDINGS,
                       takt_panel_registers[REGISTER_UPLOAD_OFFSET].address, words, data);
}

void page_orders_take_bytes(struct page_client *client, const uint8_t *bytes, size_t length)
{
    while (length > 0 && client->upload_problem == NULL) {
        const size_t piece = length < PANEL_CHUNK_MAX ? length : PANEL_CHUNK_MAX;

        client->upload_problem = write_chunk(client, bytes, (uint16_t)piece);
        client->upload_at += (uint32_t)piece;
        bytes += piece;
        length -= piece;
    }
}

static const char *commit_upload(struct page_client *client)
{
    if (client->upload_problem != NULL)
        return client->upload_problem;
    return write_number(client, REGISTER_UPLOAD_COMMAND, PANEL_UPLOAD_COMMIT);
}

static const char *read_fault(const char *words, struct page_command *command)
{
    static _Thread_local struct inject script;
    static _Thread_local struct inject_error error;
    char text[INJECT_ERROR_TEXT_MAX + 1];

    (void)snprintf(text, sizeof text, "power %s\n", words);
    if (!inject_read(&script, text, strlen(text), &error))
        return error.text;
    if (script.count != 1)
        return "one fault is expected";
    command->kind = PAGE_JOB_FAULT;
    command->fault = script.fault[0];
    return NULL;
}

/* An object as PDOs map it: index, sub-index, bits. */
static const char *read_setting(const struct page_setup *setup, const cJSON *set,
                                struct page_command *command)
{
    const double drive = number_of(set, 0), index = number_of(set, 1), sub = number_of(set, 2),
                 value = number_of(set, 3);
    const struct object_row *row;
    bool has_index;

    if (!(drive >= 0 && drive < setup->drives && index >= 0 && index <= UINT16_MAX && sub >= 0 &&
          sub <= UINT8_MAX))
        return "no such object";
    row = takt_dictionary_find(setup->drive[(unsigned)drive].dictionary, (uint16_t)index,
                               (uint8_t)sub, &has_index);
    if (row == NULL || takt_object_type_bytes((enum object_type)row->type) == 0)
        return "no such object";
    if (!(value >= INT32_MIN && value <= UINT32_MAX))
        return reasons[PANEL_REFUSAL_VALUE];
    command->kind = PAGE_JOB_WRITE;
    command->drive = (unsigned)drive;
    command->object = PDO_MAPPED((uint32_t)row->index, row->sub,
                                 8 * takt_object_type_bytes((enum object_type)row->type));
    command->value = (uint32_t)(int64_t)value;
    return NULL;
}

/* What only the control thread can do. True: it is to be asked; else *refused. */
static bool read_command(struct page_client *client, const cJSON *message,
                         struct page_command *command, const char **refused)
{
    const char *fault = cJSON_GetStringValue(cJSON_GetObjectItem(message, "fault"));
    const cJSON *set = cJSON_GetObjectItem(message, "set");

    command->page = client->number;
    *refused = client->setup->drives == 0
                   ? "the drives are not virtual ones of this process"
                   : reasons[panel_host_check_page(client->panel, client->number)];
    if (*refused != NULL)
        return false;
    if (fault != NULL)
        *refused = read_fault(fault, command);
    else if (set != NULL)
        *refused = read_setting(client->setup, set, command);
    else
        command->kind = PAGE_JOB_CLEAR;
    return *refused == NULL;
}

/* Reading is a sign of life. */
static void be_alive(struct page_client *client)
{
    uint8_t data[2];

    (void)client->map.read(client->map.context, MODBUS_INPUTS, 0, 1, data);
}

static void watch(struct page_client *client, double drive)
{
    client->watched = drive >= 0 && drive < client->setup->drives ? (int)drive : -1;
    client->is_new_watch = client->watched >= 0;
}

static const char *write_message(struct page_client *client, const cJSON *message)
{
    const cJSON *pairs = cJSON_GetObjectItem(message, "write");
    const cJSON *upload = cJSON_GetObjectItem(message, "upload");

    if (pairs != NULL)
        return write_all(client, pairs);
    if (upload != NULL)
        return begin_upload(client, upload);
    if (cJSON_HasObjectItem(message, "commit"))
        return commit_upload(client);
    return "this order is not known";
}

static bool take_message(struct page_client *client, const cJSON *message, struct page_text *reply,
                         struct page_command *command)
{
    const cJSON *id = cJSON_GetObjectItem(message, "id");
    const cJSON *watched = cJSON_GetObjectItem(message, "watch");
    const char *refused = NULL;

    if (cJSON_IsNumber(watched))
        watch(client, watched->valuedouble);
    if (cJSON_HasObjectItem(message, "alive"))
        be_alive(client);
    if (!cJSON_IsNumber(id))
        return false;
    command->id = id->valuedouble;
    if (cJSON_HasObjectItem(message, "fault") || cJSON_HasObjectItem(message, "set") ||
        cJSON_HasObjectItem(message, "clear")) {
        if (read_command(client, message, command, &refused))
            return true;
    } else {
        refused = write_message(client, message);
    }
    page_orders_reply(reply, id->valuedouble, refused);
    return false;
}

bool page_orders_take(struct page_client *client, const char *text, size_t length,
                      struct page_text *reply, struct page_command *command)
{
    cJSON *message = cJSON_ParseWithLength(text, length);
    const bool is_command = message != NULL && take_message(client, message, reply, command);

    cJSON_Delete(message);
    return is_command;
}

void page_client_close(struct page_client *client)
{
    struct panel_snapshot snapshot;

    panel_host_lock(client->panel);
    panel_host_look(client->panel, &snapshot);
    if (panel_host_get_control(client->panel, client->number, &snapshot) == PANEL_CONTROL_MINE) {
        (void)write_number(client, REGISTER_JOG_PLUS, 0);
        (void)write_number(client, REGISTER_JOG_MINUS, 0);
        if (snapshot.value[REGISTER_CYCLE_START] == 0 && snapshot.value[REGISTER_MDI_START] == 0)
            (void)write_number(client, REGISTER_WATCHDOG, 0);
    }
    panel_host_leave_page(client->panel, client->number);
    panel_host_unlock(client->panel);
}
