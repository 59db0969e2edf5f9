#include "canopen/cia402.h"

#include "base/assert.h"

/*
 * CiA 402-2, table "State coding": the statusword under the mask has the value. In the order of
 * takt_cia402_state.
 */
static const struct {
    uint8_t mask;
    uint8_t value;
} state_coding[] = {
    [CIA402_NOT_READY] = {0x4F, 0x00},      [CIA402_SWITCH_ON_DISABLED] = {0x4F, 0x40},
    [CIA402_READY] = {0x6F, 0x21},          [CIA402_SWITCHED_ON] = {0x6F, 0x23},
    [CIA402_ENABLED] = {0x6F, 0x27},        [CIA402_QUICK_STOP] = {0x6F, 0x07},
    [CIA402_FAULT_REACTION] = {0x4F, 0x0F}, [CIA402_FAULT] = {0x4F, 0x08},
};

enum cia402_state takt_cia402_state(uint16_t statusword)
{
    for (unsigned i = CIA402_FAULT; i > CIA402_NOT_READY; i--)
        if ((statusword & state_coding[i].mask) == state_coding[i].value)
            return (enum cia402_state)i;
    return CIA402_NOT_READY;
}

const char *takt_cia402_state_text(enum cia402_state state)
{
    static const char *const names[] = {
        [CIA402_NOT_READY] = "not ready to switch on",
        [CIA402_SWITCH_ON_DISABLED] = "switch on disabled",
        [CIA402_READY] = "ready to switch on",
        [CIA402_SWITCHED_ON] = "switched on",
        [CIA402_ENABLED] = "operation enabled",
        [CIA402_QUICK_STOP] = "quick stop active",
        [CIA402_FAULT_REACTION] = "fault reaction active",
        [CIA402_FAULT] = "fault",
    };
    TAKT_ASSERT(state <= CIA402_FAULT);
    return names[state];
}

uint16_t takt_cia402_statusword(enum cia402_state state)
{
    TAKT_ASSERT(state <= CIA402_FAULT);
    return state_coding[state].value;
}

/* CiA 402-2, table "Command coding"; fault reset is an edge and therefore apart. */
enum command { DISABLE_VOLTAGE, QUICK_STOP, SHUTDOWN, SWITCH_ON, ENABLE_OPERATION };

static enum command command_of(uint16_t controlword)
{
    if (!(controlword & 0x02))
        return DISABLE_VOLTAGE;
    if (!(controlword & 0x04))
        return QUICK_STOP;
    if (!(controlword & 0x01))
        return SHUTDOWN;
    return controlword & 0x08 ? ENABLE_OPERATION : SWITCH_ON;
}

/*
 * Transitions 3 to 11, out of READY, SWITCHED_ON and ENABLED. Enable operation in READY switches on
 * and enables in one step, as the note to the command coding says.
 */
static enum cia402_state after_powered(enum cia402_state state, enum command command)
{
    switch (command) {
    case DISABLE_VOLTAGE:
        return CIA402_SWITCH_ON_DISABLED;
    case QUICK_STOP:
        return state == CIA402_ENABLED ? CIA402_QUICK_STOP : CIA402_SWITCH_ON_DISABLED;
    case SHUTDOWN:
        return CIA402_READY;
    case SWITCH_ON:
        return CIA402_SWITCHED_ON;
    case ENABLE_OPERATION:
        break;
    }
    return CIA402_ENABLED;
}

enum cia402_state takt_cia402_next_state(enum cia402_state state, uint16_t controlword,
                                         uint16_t previous)
{
    enum command command = command_of(controlword);
    switch (state) {
    case CIA402_SWITCH_ON_DISABLED:
        return command == SHUTDOWN ? CIA402_READY : state;
    case CIA402_READY:
    case CIA402_SWITCHED_ON:
    case CIA402_ENABLED:
        return after_powered(state, command);
    case CIA402_QUICK_STOP:
        return command == DISABLE_VOLTAGE ? CIA402_SWITCH_ON_DISABLED : state;
    case CIA402_FAULT:
        return controlword & ~previous & CIA402_FAULT_RESET ? CIA402_SWITCH_ON_DISABLED : state;
    case CIA402_NOT_READY:
    case CIA402_FAULT_REACTION:
        break;
    }
    return state;
}

uint16_t takt_cia402_step_to_enabled(enum cia402_state state)
{
    switch (state) {
    case CIA402_SWITCH_ON_DISABLED:
        return CIA402_SHUTDOWN;
    case CIA402_READY:
        return CIA402_SWITCH_ON;
    case CIA402_SWITCHED_ON:
    case CIA402_ENABLED:
        return CIA402_ENABLE_OPERATION;
    case CIA402_FAULT:
        return CIA402_FAULT_RESET;
    case CIA402_NOT_READY:
    case CIA402_QUICK_STOP:
    case CIA402_FAULT_REACTION:
        break;
    }
    return CIA402_DISABLE_VOLTAGE;
}
