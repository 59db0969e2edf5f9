/*
 * Somebody else's image, with takt inside: a machine without drives on its bus. It says what takt
 * logs, until takt finds that the first drive is missing.
 */
#include <takt.h>

#include <stdio.h>

#define CYCLES_MAX 10000

static struct embedded embedded;
static struct embedded_core core;
static struct machine machine;
static struct tool tools[10];
static uint32_t now_us_count;
static unsigned long frames;

static bool bus_send(void *context, const struct can_frame *frame)
{
    (void)context;
    (void)frame;
    frames++;
    return true;
}

static bool bus_receive(void *context, struct can_frame *frame)
{
    (void)context;
    (void)frame;
    return false;
}

static void nothing(void *context)
{
    (void)context;
}

static uint32_t now(void *context)
{
    (void)context;
    return now_us_count;
}

static void reply(void *context, const uint8_t *bytes, size_t length)
{
    (void)context;
    (void)bytes;
    printf("%zu bytes to the panel\n", length);
}

static void log_line(void *context, const char *text)
{
    (void)context;
    puts(text);
}

int main(void)
{
    const struct embedded_config config = {
        .machine = &machine,
        .core = &core,
        .can = {.port = {{.send = bus_send, .receive = bus_receive}}},
        .tools = tools,
        .tools_count = sizeof tools / sizeof tools[0],
        .port = {.lock = nothing,
                 .unlock = nothing,
                 .now_us = now,
                 .now_ns = now,
                 .reply = reply,
                 .log = log_line},
        .unit = 1,
        .gap_us = 1750,
        .name = "takt in a machine of mine",
    };
    const struct inputs inputs = inputs_idle();

    takt_machine_set_default(&machine);
    takt_embedded_init(&embedded, &config);
    for (unsigned i = 0; i < CYCLES_MAX; i++) {
        takt_embedded_background(&embedded);
        takt_embedded_cycle(&embedded, &inputs, false);
        now_us_count += machine.cycle_us;
    }
    printf("%lu frames\n", frames);
    return frames > 0 ? 0 : 1;
}
