/* Uploads of settings by a panel, and why they were refused. */
#include "base/assert.h"
#include "panel/panel_private.h"

#include <string.h>

void takt_panel_turn_upload(struct panel *panel, enum panel_upload_kind kind)
{
    TAKT_ASSERT(kind <= PANEL_UPLOAD_PLAN);
    if (panel->kind == kind)
        return;
    takt_panel_upload_abandon(&panel->upload, takt_panel_get_store(panel));
    panel->kind = kind;
}

enum panel_refusal takt_panel_tell_why(struct panel *panel, enum panel_refusal refusal)
{
    const struct panel_store *store = takt_panel_get_store(panel);

    memset(panel->upload_text, 0, sizeof panel->upload_text);
    if (store->why != NULL)
        store->why(store->context, panel->upload_text);
    return refusal;
}

enum panel_refusal takt_panel_begin_settings(struct panel *panel,
                                             const struct panel_mailbox *mailbox)
{
    const struct panel_store *store = &panel->config.settings;

    if (store->begin == NULL || mailbox->upload_size == 0)
        return PANEL_REFUSAL_VALUE;
    if (!takt_panel_upload_begin(&panel->upload, store, mailbox->upload_size, mailbox->upload_crc))
        return takt_panel_tell_why(panel, PANEL_REFUSAL_STATE);
    memset(panel->upload_text, 0, sizeof panel->upload_text);
    return PANEL_REFUSAL_NONE;
}

/*
 * They are looked at as a whole before they replace those that are there; no order is needed: they
 * count later.
 */
enum panel_refusal takt_panel_commit_settings(struct panel *panel)
{
    const struct panel_store *store = &panel->config.settings;
    bool good;

    if (panel->upload.state != PANEL_UPLOAD_WHOLE)
        return PANEL_REFUSAL_STATE;
    if (!takt_panel_upload_is_right(&panel->upload))
        return PANEL_REFUSAL_VALUE;
    good = store->prepare(store->context) && store->place(store->context);
    takt_panel_upload_abandon(&panel->upload, store);
    return good ? PANEL_REFUSAL_NONE : takt_panel_tell_why(panel, PANEL_REFUSAL_VALUE);
}
