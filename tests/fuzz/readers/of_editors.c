#define _POSIX_C_SOURCE 200809L

/* What an editor sends to `takt lsp`. */
#include "readers.h"

#include "editor/lsp.h"
#include "editor/lsp_frames.h"
#include "editor/lsp_text.h"

#include <cjson/cJSON.h>
#include <string.h>

#define LINES_MAX 1000

static void require_json(void *context, const char *json)
{
    cJSON *message = cJSON_Parse(json);

    (void)context;
    require(message != NULL);
    cJSON_Delete(message);
}

/* Whatever the program's bytes are. What names it comes from the editor, and is ASCII here. */
static void require_text(void *context, const char *json)
{
    char *copy = strdup(json);

    require(copy != NULL);
    lsp_text_clean(copy);
    require(strcmp(copy, json) == 0);
    free(copy);
    require_json(context, json);
}

/*
 * The bytes as they come; then as a program that the editor has open, with a question about every
 * place of its first lines.
 */
static void hear_bytes(const struct options *options, const uint8_t *data, size_t size)
{
    struct lsp server = {.options = options, .write = require_json};
    struct lsp_frames frames = {0};
    const char *json;
    size_t length;

    require(lsp_frames_add(&frames, (const char *)data, size));
    while (!server.ended && lsp_frames_next(&frames, &json, &length) == LSP_FRAME_WHOLE)
        lsp_hear(&server, json, length);
    lsp_rest(&server);
    lsp_close(&server);
    lsp_frames_close(&frames);
}

static void hear(struct lsp *server, const char *method, cJSON *params)
{
    cJSON *message = cJSON_CreateObject();

    (void)cJSON_AddNumberToObject(message, "id", 1);
    (void)cJSON_AddStringToObject(message, "method", method);
    (void)cJSON_AddItemToObject(message, "params", params);
    char *json = cJSON_PrintUnformatted(message);

    lsp_hear(server, json, strlen(json));
    cJSON_free(json);
    cJSON_Delete(message);
}

static cJSON *about(unsigned line, unsigned character)
{
    cJSON *params = cJSON_CreateObject();
    cJSON *document = cJSON_AddObjectToObject(params, "textDocument");
    cJSON *at = cJSON_AddObjectToObject(params, "position");

    (void)cJSON_AddStringToObject(document, "uri", "file:///nowhere/a%20b.ngc");
    (void)cJSON_AddNumberToObject(at, "line", line);
    (void)cJSON_AddNumberToObject(at, "character", character);
    return params;
}

static void hear_program(const struct options *options, const uint8_t *data, size_t size)
{
    struct lsp server = {.options = options, .write = require_text, .initialized = true};
    char *text = malloc(size + 1);
    cJSON *open = about(0, 0);
    cJSON *notification = cJSON_CreateObject();

    require(text != NULL);
    for (size_t i = 0; i < size; i++)
        text[i] = (char)(data[i] == 0 ? '?' : data[i]);
    text[size] = '\0';
    (void)cJSON_AddStringToObject(cJSON_GetObjectItem(open, "textDocument"), "text", text);
    (void)cJSON_AddStringToObject(notification, "method", "textDocument/didOpen");
    (void)cJSON_AddItemToObject(notification, "params", open);
    char *json = cJSON_PrintUnformatted(notification);

    lsp_hear(&server, json, strlen(json));
    lsp_rest(&server);
    for (unsigned line = 0; line < 4; line++) {
        hear(&server, "textDocument/definition", about(line, 0));
        for (unsigned character = 0; character < 16; character += 5)
            hear(&server, "textDocument/hover", about(line, character));
    }
    lsp_close(&server);
    cJSON_free(json);
    cJSON_Delete(notification);
    free(text);
}

void read_editor(const uint8_t *data, size_t size)
{
    const struct options options = {.lines_max = LINES_MAX};

    if (size >= 8 && memcmp(data, "Content-", 8) == 0)
        hear_bytes(&options, data, size);
    else
        hear_program(&options, data, size);
}
