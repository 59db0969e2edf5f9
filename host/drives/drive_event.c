#include "drives/drive_event.h"
#include "canopen/cia402.h"
#include "canopen/emcy.h"
#include "canopen/nmt.h"
#include "inject/inject.h"

#define NS_PER_US 1000u
#define US_PER_S  1000000u

static const char *nmt_name(uint32_t state)
{
    if (state == NMT_OPERATIONAL)
        return "operational";
    if (state == NMT_PREOPERATIONAL)
        return "pre-operational";
    return state == NMT_STOPPED ? "stopped" : "initialising";
}

static const char *mode_name(uint32_t mode)
{
    switch (mode) {
    case CIA402_MODE_PROFILE_POSITION:
        return "profile position";
    case CIA402_MODE_PROFILE_VELOCITY:
        return "profile velocity";
    case CIA402_MODE_PROFILE_TORQUE:
        return "profile torque";
    case CIA402_MODE_HOMING:
        return "homing";
    case CIA402_MODE_INTERPOLATED_POSITION:
        return "interpolated position";
    case CIA402_MODE_CYCLIC_SYNC_POSITION:
        return "cyclic synchronous position";
    case CIA402_MODE_CYCLIC_SYNC_VELOCITY:
        return "cyclic synchronous velocity";
    case CIA402_MODE_CYCLIC_SYNC_TORQUE:
        return "cyclic synchronous torque";
    default:
        return "none";
    }
}

static void write_emcy(FILE *stream, const struct drive_event *event)
{
    if (event->first == EMCY_NONE)
        (void)fprintf(stream, "EMCY 0000: errors are gone, register %02X\n",
                      (unsigned)event->second);
    else
        (void)fprintf(stream, "EMCY %04X: %s, register %02X\n", (unsigned)event->first,
                      takt_emcy_text((uint16_t)event->first), (unsigned)event->second);
}

static void write_homing(FILE *stream, const struct drive_event *event)
{
    static const char *const what[] = {"begun", "attained", "interrupted", "failed"};
    (void)fprintf(stream, "homing %s, method %u\n", what[event->first & 3],
                  (unsigned)event->second);
}

static void write_sdo_abort(FILE *stream, const struct drive_event *event)
{
    (void)fprintf(stream, "SDO for %04X:%02X aborted: %08X\n", (unsigned)(event->first >> 16),
                  (unsigned)(event->first >> 8 & 0xFF), (unsigned)event->second);
}

static void write_fault(FILE *stream, const struct drive_event *event)
{
    (void)fprintf(stream, "scripted fault %s of line %u\n",
                  inject_name((enum inject_kind)event->second), (unsigned)event->first);
}

static void write_what(FILE *stream, const struct drive_event *event)
{
    switch (event->kind) {
    case DRIVE_EVENT_BOOT:
        (void)fputs("boot-up\n", stream);
        break;
    case DRIVE_EVENT_NMT:
        (void)fprintf(stream, "NMT %s\n", nmt_name(event->first));
        break;
    case DRIVE_EVENT_STATE:
        (void)fprintf(stream, "%s -> %s\n", takt_cia402_state_text((enum cia402_state)event->first),
                      takt_cia402_state_text((enum cia402_state)event->second));
        break;
    case DRIVE_EVENT_MODE:
        (void)fprintf(stream, "mode %s\n", mode_name(event->first));
        break;
    case DRIVE_EVENT_EMCY:
        write_emcy(stream, event);
        break;
    case DRIVE_EVENT_PDO:
        (void)fprintf(stream, "PDO %04X is %08X\n", (unsigned)event->first,
                      (unsigned)event->second);
        break;
    case DRIVE_EVENT_SDO_ABORT:
        write_sdo_abort(stream, event);
        break;
    case DRIVE_EVENT_SETPOINT:
        (void)fprintf(stream, "target %ld increments\n", (long)(int32_t)event->first);
        break;
    case DRIVE_EVENT_HOMING:
        write_homing(stream, event);
        break;
    case DRIVE_EVENT_PROBE:
        (void)fprintf(stream, "touch probe %u at %ld increments\n", (unsigned)event->first,
                      (long)(int32_t)event->second);
        break;
    case DRIVE_EVENT_TIME:
        (void)fprintf(stream, "TIME %u ms of day %u\n", (unsigned)event->first,
                      (unsigned)event->second);
        break;
    case DRIVE_EVENT_FAULT:
        write_fault(stream, event);
        break;
    case DRIVE_EVENT_FAULT_END:
        (void)fputs("end of ", stream);
        write_fault(stream, event);
        break;
    }
}

void drive_event_write(FILE *stream, const struct drive_event *event)
{
    uint64_t time_us = event->time_ns / NS_PER_US;
    (void)fprintf(stream, "%llu.%06u node %u: ", (unsigned long long)(time_us / US_PER_S),
                  (unsigned)(time_us % US_PER_S), (unsigned)event->node);
    write_what(stream, event);
}
