/* Uploads as a request asks for them: begun, brought in chunks, committed, run while they come. */
#include "base/assert.h"
#include "panel/panel_private.h"

#include <string.h>

/* The controller alone knows whether a program may be taken now. */
static enum panel_refusal hand_over(struct panel_request *r, uint32_t size, uint32_t crc)
{
    TAKT_ASSERT(r->client != NULL && r->client->panel != NULL);
    takt_panel_add_order(r, REGISTER_UPLOAD_SIZE, size);
    takt_panel_add_order(r, REGISTER_UPLOAD_CRC, crc);
    takt_panel_add_order(r, REGISTER_UPLOAD_COMMAND, r->command);
    return takt_panel_give_order(r);
}

/* A program planned ahead: the controller makes room for it, if it can take one now. */
static enum panel_refusal begin_plan(struct panel_request *r)
{
    struct panel *panel = r->client->panel;
    const struct panel_store *store = &panel->config.plans;
    enum panel_refusal refusal;

    if (store->begin_stream == NULL || r->mailbox.upload_size == 0)
        return PANEL_REFUSAL_VALUE;
    takt_panel_upload_abandon(&panel->upload, takt_panel_get_store(panel));
    panel->kind = PANEL_UPLOAD_PLAN;
    takt_panel_add_order(r, REGISTER_UPLOAD_KIND, PANEL_UPLOAD_PLAN);
    refusal = takt_panel_give_order(r);
    if (refusal != PANEL_REFUSAL_NONE)
        return refusal;
    memset(panel->upload_text, 0, sizeof panel->upload_text);
    return takt_panel_upload_stream(&panel->upload, store, r->mailbox.upload_size,
                                    r->mailbox.upload_crc)
               ? PANEL_REFUSAL_NONE
               : PANEL_REFUSAL_VALUE;
}

/* The program before is gone as soon as the first byte of this one may come. */
static enum panel_refusal begin_stream(struct panel_request *r)
{
    struct panel *panel = r->client->panel;
    const struct panel_mailbox *mailbox = &r->mailbox;
    const struct panel_store *store = &panel->config.store;
    enum panel_refusal refusal;

    if (r->state != PANEL_IDLE)
        return PANEL_REFUSAL_STATE;
    if (mailbox->upload_kind == PANEL_UPLOAD_PLAN)
        return begin_plan(r);
    if (store->begin_stream == NULL || mailbox->upload_size == 0)
        return PANEL_REFUSAL_VALUE;
    takt_panel_turn_upload(panel, PANEL_UPLOAD_PROGRAM);
    if (!takt_panel_upload_stream(&panel->upload, store, mailbox->upload_size, mailbox->upload_crc))
        return PANEL_REFUSAL_STATE;
    refusal = hand_over(r, mailbox->upload_size, mailbox->upload_crc);
    if (refusal != PANEL_REFUSAL_NONE)
        takt_panel_upload_abandon(&panel->upload, store);
    return refusal;
}

/* The new one cannot be kept: the controller takes the one before again, which waits beside it. */
static enum panel_refusal take_back(struct panel_request *r)
{
    r->order.count = 0;
    (void)hand_over(r, r->program_size, r->program_crc);
    return PANEL_REFUSAL_BUSY;
}

/*
 * Made durable first, then handed to the controller, which alone knows whether it may be taken now,
 * then put in its place. Whatever fails, there is one whole program.
 */
static enum panel_refusal commit(struct panel_request *r)
{
    struct panel *panel = r->client->panel;
    const struct panel_store *store = &panel->config.store;
    enum panel_refusal refusal;

    if (panel->upload.state != PANEL_UPLOAD_WHOLE || panel->upload.is_stream)
        return PANEL_REFUSAL_STATE;
    if (!takt_panel_upload_is_right(&panel->upload))
        return PANEL_REFUSAL_VALUE;
    if (r->state != PANEL_IDLE)
        return PANEL_REFUSAL_STATE;
    if (!store->prepare(store->context))
        return PANEL_REFUSAL_BUSY;
    refusal = hand_over(r, panel->upload.size, panel->upload.crc);
    if (refusal != PANEL_REFUSAL_NONE)
        return refusal;
    if (!store->place(store->context))
        return take_back(r);
    takt_panel_upload_abandon(&panel->upload, store);
    return PANEL_REFUSAL_NONE;
}

/* What is brought now is run already: to begin another upload would end it in its midst. */
static bool is_run_while_it_comes(const struct panel_request *r)
{
    const struct panel_upload *upload = &r->client->panel->upload;

    return upload->is_stream && upload->state == PANEL_UPLOAD_OPEN && r->state >= PANEL_RUNNING &&
           r->state <= PANEL_STOPPING;
}

static bool goes_on(const struct panel *panel, const struct panel_mailbox *mailbox)
{
    return panel->kind == mailbox->upload_kind && panel->upload.size == mailbox->upload_size &&
           panel->upload.crc == mailbox->upload_crc;
}

static enum panel_refusal begin(const struct panel_request *r)
{
    struct panel *panel = r->client->panel;
    const struct panel_mailbox *mailbox = &r->mailbox;

    if (mailbox->upload_kind == PANEL_UPLOAD_PLAN)
        return PANEL_REFUSAL_VALUE;
    if (is_run_while_it_comes(r) && !goes_on(panel, mailbox))
        return PANEL_REFUSAL_STATE;
    takt_panel_turn_upload(panel, mailbox->upload_kind);
    if (panel->kind == PANEL_UPLOAD_SETTINGS)
        return takt_panel_begin_settings(panel, mailbox);
    return mailbox->upload_size > 0 &&
                   takt_panel_upload_begin(&panel->upload, &panel->config.store,
                                           mailbox->upload_size, mailbox->upload_crc)
               ? PANEL_REFUSAL_NONE
               : PANEL_REFUSAL_VALUE;
}

enum panel_refusal takt_panel_command_upload(struct panel_request *r)
{
    struct panel *panel = r->client->panel;

    switch (r->command) {
    case PANEL_UPLOAD_BEGIN:
        return begin(r);
    case PANEL_UPLOAD_COMMIT:
        return panel->kind == PANEL_UPLOAD_SETTINGS ? takt_panel_commit_settings(panel) : commit(r);
    case PANEL_UPLOAD_STREAM:
        return begin_stream(r);
    case PANEL_UPLOAD_ABANDON:
        takt_panel_upload_abandon(&panel->upload, takt_panel_get_store(panel));
        break;
    }
    return PANEL_REFUSAL_NONE;
}

enum panel_refusal takt_panel_take_chunk(const struct panel_request *r)
{
    struct panel *panel = r->client->panel;

    if (panel->upload.state == PANEL_UPLOAD_NONE)
        return PANEL_REFUSAL_STATE;
    if (r->mailbox.chunk_offset <= panel->upload.received &&
        r->mailbox.chunk_length >
            panel->upload.received - r->mailbox.chunk_offset +
                takt_panel_upload_room(&panel->upload, takt_panel_get_store(panel)) &&
        r->mailbox.chunk_length <= panel->upload.size - r->mailbox.chunk_offset)
        return PANEL_REFUSAL_BUSY;
    if (takt_panel_upload_take(&panel->upload, takt_panel_get_store(panel), r->mailbox.chunk_offset,
                               r->mailbox.chunk, r->mailbox.chunk_length, r->check))
        return PANEL_REFUSAL_NONE;
    return panel->kind == PANEL_UPLOAD_PLAN ? takt_panel_tell_why(panel, PANEL_REFUSAL_VALUE)
                                            : PANEL_REFUSAL_VALUE;
}
