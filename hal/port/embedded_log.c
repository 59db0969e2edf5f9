#include "port/embedded_log.h"

static const char *const state_names[PANEL_STATES] = {
    "starting", "idle", "running",  "MDI",   "jogging",
    "homing",   "held", "stopping", "alarm", "emergency stop",
};

static const char *const outcome_names[] = {"none", "completed", "aborted", "failed"};

void takt_embedded_log_line(const struct embedded *e, const char *text)
{
    e->config.port.log(e->config.port.context, text);
}

static size_t append(char *line, size_t at, const char *text)
{
    while (*text != '\0' && at + 1 < EMBEDDED_LOG_MAX)
        line[at++] = *text++;
    line[at] = '\0';
    return at;
}

static void log_pair(const struct embedded *e, const char *word, const char *text)
{
    char line[EMBEDDED_LOG_MAX];

    (void)append(line, append(line, 0, word), text);
    takt_embedded_log_line(e, line);
}

void takt_embedded_log_alarm(const struct embedded *e, const struct diagnostic *alarm)
{
    char text[DIAGNOSTIC_TEXT_MAX];

    (void)takt_diagnostic_text(alarm, text);
    log_pair(e, "alarm: ", text);
}

/* "completed, setpoints 0123456789abcdef" */
static void log_outcome(const struct embedded *e)
{
    static const char digits[] = "0123456789abcdef";
    char digest[17];
    char line[EMBEDDED_LOG_MAX];
    size_t at = append(line, 0, outcome_names[e->service.ended]);

    for (unsigned i = 0; i < 16; i++)
        digest[i] = digits[e->service.digest >> (60 - 4 * i) & 15U];
    digest[16] = '\0';
    at = append(line, at, ", setpoints ");
    (void)append(line, at, digest);
    takt_embedded_log_line(e, line);
}

void takt_embedded_log_changes(struct embedded *e)
{
    const enum panel_state state = takt_service_get_state(&e->service);

    if (e->service.runs != e->logged_runs)
        log_outcome(e);
    e->logged_runs = e->service.runs;
    if (e->service.alarm != e->logged_alarm && e->service.alarm != PANEL_ALARM_NONE)
        takt_embedded_log_alarm(e, &e->service.alarm_text);
    e->logged_alarm = e->service.alarm;
    if (state != e->logged_state)
        log_pair(e, "state: ", state_names[state]);
    e->logged_state = state;
}
