/*
 * What passes between the panel and the controller: a snapshot one way, orders the other.
 */
#ifndef TAKT_PANEL_SNAPSHOT_H
#define TAKT_PANEL_SNAPSHOT_H

#include "panel/registers.h"

/*
 * The value of every register at one moment, in counts of its row; below 0 in two's complement, as
 * on the wire. Registers that belong to the mailbox or to one client (UPLOAD_..., MDI_TEXT,
 * PASSWORD, REFUSAL, CONTROL, VERSION, PROGRAM_MAX) are not used.
 */
struct panel_snapshot {
    uint32_t value[REGISTER_COUNT];
    char alarm_text[PANEL_ALARM_TEXT_MAX]; /* ends with a zero, or its last character */
};

/* With its sign. */
static inline int64_t panel_value(const struct panel_snapshot *snapshot, enum panel_id id)
{
    const uint32_t bits = snapshot->value[id];

    return takt_panel_registers[id].form == PANEL_S32 ? (int32_t)bits : (int64_t)bits;
}

/* As much as one request can write: the holding registers, of which there are more than coils. */
#define PANEL_HOLDING_ID(id, table, address, form, words, unit, decimals, least, most, states,     \
                         meaning)                                                                  \
    PANEL_HOLDING_##id,
enum panel_holding { PANEL_HOLDING_ROWS(PANEL_HOLDING_ID) PANEL_ORDER_MAX };
#undef PANEL_HOLDING_ID

/* What MDI_START starts. */
enum panel_order_text {
    PANEL_ORDER_MDI,  /* the line of the order */
    PANEL_ORDER_JOG,  /* likewise, as a jog */
    PANEL_ORDER_LINES /* the lines of the console, as they come */
};

/* What one request wants changed: all of it, or nothing. */
struct panel_order {
    unsigned count;
    struct panel_order_item {
        enum panel_id id;
        int64_t value;
    } item[PANEL_ORDER_MAX];
    enum panel_order_text text;
    char mdi[PANEL_MDI_MAX + 1]; /* with MDI_START: the line, ends with a zero */
};

enum panel_verdict {
    PANEL_DONE,
    PANEL_WRONG_STATE,
    PANEL_WRONG_VALUE,
    PANEL_TRY_AGAIN /* the controller has not taken it in time; it is not done */
};

/* Who stands behind the panel. */
struct panel_port {
    /* The latest snapshot. Must not wait. */
    void (*look)(void *context, struct panel_snapshot *snapshot);
    /*
     * Does what is ordered, all or nothing; snapshots from now on show it. May wait for a control
     * cycle.
     */
    enum panel_verdict (*order)(void *context, const struct panel_order *order);
    /* The panel in control has asked something: the watchdog starts anew. */
    void (*alive)(void *context);
    void *context; /* owned by whoever made the port */
};

#endif
