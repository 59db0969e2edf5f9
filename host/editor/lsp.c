#define _POSIX_C_SOURCE 200809L

#include "editor/lsp.h"

#include "cli/interrupt.h"
#include "editor/lsp_program.h"
#include "editor/lsp_text.h"

#include <cjson/cJSON.h>
#include <stdlib.h>
#include <string.h>

/* Errors of JSON-RPC and of the protocol. */
#define ERROR_PARSE           (-32700)
#define ERROR_REQUEST         (-32600)
#define ERROR_METHOD          (-32601)
#define ERROR_PARAMETERS      (-32602)
#define ERROR_NOT_INITIALIZED (-32002)
/* TextDocumentSyncKind: the whole text each time. */
#define SYNC_FULL 1

/* ---- out ---- */

static void send_message(struct lsp *s, cJSON *message)
{
    (void)cJSON_AddStringToObject(message, "jsonrpc", "2.0");
    char *json = cJSON_PrintUnformatted(message);

    if (json != NULL)
        s->write(s->context, json);
    cJSON_free(json);
    cJSON_Delete(message);
}

/* id is copied; a request that could not be read has none. */
static cJSON *begin_answer(const cJSON *id)
{
    cJSON *answer = cJSON_CreateObject();

    (void)cJSON_AddItemToObject(answer, "id",
                                id != NULL ? cJSON_Duplicate(id, true) : cJSON_CreateNull());
    return answer;
}

static void answer(struct lsp *s, const cJSON *id, cJSON *result)
{
    cJSON *message = begin_answer(id);

    (void)cJSON_AddItemToObject(message, "result", result);
    send_message(s, message);
}

static void refuse(struct lsp *s, const cJSON *id, int code, const char *why)
{
    cJSON *message = begin_answer(id);
    cJSON *error = cJSON_AddObjectToObject(message, "error");

    (void)cJSON_AddNumberToObject(error, "code", code);
    (void)cJSON_AddStringToObject(error, "message", why);
    send_message(s, message);
}

static void publish(struct lsp *s, const char *uri, cJSON *diagnostics)
{
    cJSON *message = cJSON_CreateObject();
    (void)cJSON_AddStringToObject(message, "method", "textDocument/publishDiagnostics");
    cJSON *params = cJSON_AddObjectToObject(message, "params");

    (void)cJSON_AddStringToObject(params, "uri", uri);
    (void)cJSON_AddItemToObject(params, "diagnostics", diagnostics);
    send_message(s, message);
}

/* ---- documents ---- */

static const char *text_of(const cJSON *object, const char *name)
{
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, name));
}

static const cJSON *item_of(const cJSON *object, const char *name)
{
    return cJSON_GetObjectItemCaseSensitive(object, name);
}

/* The document that parameters are about; NULL: it is not open. */
static struct lsp_document *find_document(const struct lsp *s, const cJSON *params)
{
    const char *uri = text_of(item_of(params, "textDocument"), "uri");

    for (unsigned i = 0; i < s->documents && uri != NULL; i++) {
        if (strcmp(s->document[i].uri, uri) == 0)
            return &s->document[i];
    }
    return NULL;
}

static void free_document(struct lsp_document *d)
{
    free(d->uri);
    free(d->path);
    free(d->text);
}

static void set_text(struct lsp_document *d, const char *text)
{
    char *copy = text != NULL ? strdup(text) : NULL;

    if (copy == NULL)
        return;
    free(d->text);
    d->text = copy;
    d->changed = true;
}

static struct lsp_document *add_document(struct lsp *s, const char *uri)
{
    struct lsp_document d = {.uri = strdup(uri), .path = lsp_text_path(uri), .text = strdup("")};
    struct lsp_document *grown = realloc(s->document, (s->documents + 1) * sizeof *s->document);

    if (grown != NULL)
        s->document = grown;
    if (grown == NULL || d.uri == NULL || d.path == NULL || d.text == NULL) {
        free_document(&d);
        return NULL;
    }
    s->document[s->documents] = d;
    return &s->document[s->documents++];
}

static void did_open(struct lsp *s, const cJSON *params)
{
    const cJSON *item = item_of(params, "textDocument");
    const char *uri = text_of(item, "uri");
    struct lsp_document *d = find_document(s, params);

    if (uri != NULL && d == NULL)
        d = add_document(s, uri);
    if (d != NULL)
        set_text(d, text_of(item, "text"));
}

static void did_change(struct lsp *s, const cJSON *params)
{
    struct lsp_document *d = find_document(s, params);
    const cJSON *changes = item_of(params, "contentChanges");
    const cJSON *change;

    cJSON_ArrayForEach(change, changes)
    {
        if (d != NULL && item_of(change, "range") == NULL)
            set_text(d, text_of(change, "text"));
    }
}

/* What is saved may be a subroutine of any other. */
static void did_save(struct lsp *s, const cJSON *params)
{
    (void)params;
    for (unsigned i = 0; i < s->documents; i++)
        s->document[i].changed = true;
}

static void did_close(struct lsp *s, const cJSON *params)
{
    struct lsp_document *d = find_document(s, params);

    if (d == NULL)
        return;
    publish(s, d->uri, cJSON_CreateArray());
    free_document(d);
    *d = s->document[--s->documents];
}

static struct lsp_program program_of(const struct lsp *s, const struct lsp_document *d)
{
    return (struct lsp_program){
        .options = s->options,
        .stock_top_mm = s->stock_top_mm,
        .uri = d->uri,
        .path = d->path,
        .text = d->text,
        .length = strlen(d->text),
    };
}

void lsp_rest(struct lsp *s)
{
    for (unsigned i = 0; i < s->documents && !interrupt_asked(); i++) {
        struct lsp_document *d = &s->document[i];

        if (d->changed) {
            const struct lsp_program program = program_of(s, d);

            d->changed = false;
            publish(s, d->uri, lsp_program_check(&program));
        }
    }
}

/* ---- requests ---- */

static void initialize(struct lsp *s, const cJSON *id, const cJSON *params)
{
    cJSON *result = cJSON_CreateObject();
    cJSON *can = cJSON_AddObjectToObject(result, "capabilities");
    cJSON *sync = cJSON_AddObjectToObject(can, "textDocumentSync");
    cJSON *info = cJSON_AddObjectToObject(result, "serverInfo");

    (void)params;
    (void)cJSON_AddStringToObject(can, "positionEncoding", "utf-16");
    (void)cJSON_AddTrueToObject(sync, "openClose");
    (void)cJSON_AddNumberToObject(sync, "change", SYNC_FULL);
    (void)cJSON_AddTrueToObject(sync, "save");
    (void)cJSON_AddTrueToObject(can, "hoverProvider");
    (void)cJSON_AddTrueToObject(can, "definitionProvider");
    (void)cJSON_AddStringToObject(info, "name", "takt");
    (void)cJSON_AddStringToObject(info, "version", TAKT_VERSION);
    s->initialized = true;
    answer(s, id, result);
}

static void shut_down(struct lsp *s, const cJSON *id, const cJSON *params)
{
    (void)params;
    s->shut_down = true;
    answer(s, id, cJSON_CreateNull());
}

typedef cJSON *place_answer(const struct lsp_program *p, uint32_t line, size_t character);

static void answer_place(struct lsp *s, const cJSON *id, const cJSON *params, place_answer *ask)
{
    const struct lsp_document *d = find_document(s, params);
    const cJSON *at = item_of(params, "position");
    const cJSON *line = item_of(at, "line");
    const cJSON *character = item_of(at, "character");

    if (d == NULL || !cJSON_IsNumber(line) || !cJSON_IsNumber(character) || line->valueint < 0 ||
        character->valueint < 0) {
        refuse(s, id, ERROR_PARAMETERS, "a place in an open document is expected");
        return;
    }
    const struct lsp_program program = program_of(s, d);

    answer(s, id, ask(&program, (uint32_t)line->valueint, (size_t)character->valueint));
}

static void hover(struct lsp *s, const cJSON *id, const cJSON *params)
{
    answer_place(s, id, params, lsp_program_hover);
}

static void definition(struct lsp *s, const cJSON *id, const cJSON *params)
{
    answer_place(s, id, params, lsp_program_definition);
}

/* ---- in ---- */

static const struct {
    const char *method;
    void (*run)(struct lsp *s, const cJSON *id, const cJSON *params);
} requests[] = {
    {"initialize", initialize},
    {"shutdown", shut_down},
    {"textDocument/hover", hover},
    {"textDocument/definition", definition},
};

static const struct {
    const char *method;
    void (*run)(struct lsp *s, const cJSON *params);
} notifications[] = {
    {"textDocument/didOpen", did_open},
    {"textDocument/didChange", did_change},
    {"textDocument/didSave", did_save},
    {"textDocument/didClose", did_close},
};

static void take_request(struct lsp *s, const char *method, const cJSON *id, const cJSON *params)
{
    const bool begins = strcmp(method, "initialize") == 0;

    if (s->shut_down || (begins && s->initialized)) {
        refuse(s, id, ERROR_REQUEST, "this request may not come now");
        return;
    }
    if (!s->initialized && !begins) {
        refuse(s, id, ERROR_NOT_INITIALIZED, "initialize is the first request");
        return;
    }
    for (size_t i = 0; i < sizeof requests / sizeof requests[0]; i++) {
        if (strcmp(requests[i].method, method) == 0) {
            requests[i].run(s, id, params);
            return;
        }
    }
    refuse(s, id, ERROR_METHOD, "takt does not have this method");
}

static void take_notification(struct lsp *s, const char *method, const cJSON *params)
{
    if (strcmp(method, "exit") == 0)
        s->ended = true;
    for (size_t i = 0; i < sizeof notifications / sizeof notifications[0]; i++) {
        if (s->initialized && !s->shut_down && strcmp(notifications[i].method, method) == 0)
            notifications[i].run(s, params);
    }
}

void lsp_hear(struct lsp *s, const char *json, size_t length)
{
    cJSON *message = cJSON_ParseWithLength(json, length);
    const cJSON *id = item_of(message, "id");
    const cJSON *params = item_of(message, "params");
    const char *method = text_of(message, "method");

    if (message == NULL)
        refuse(s, NULL, ERROR_PARSE, "this is no JSON");
    else if (method == NULL && item_of(message, "result") == NULL &&
             item_of(message, "error") == NULL)
        refuse(s, id, ERROR_REQUEST, "this is no request");
    else if (method != NULL && id != NULL)
        take_request(s, method, id, params);
    else if (method != NULL)
        take_notification(s, method, params);
    cJSON_Delete(message);
}

void lsp_close(struct lsp *s)
{
    for (unsigned i = 0; i < s->documents; i++)
        free_document(&s->document[i]);
    free(s->document);
    s->document = NULL;
    s->documents = 0;
}
