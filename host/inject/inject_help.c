/*
 * The table of faults and keys, and the manual printed from it.
 */
#include "inject/inject_private.h"

#define NODE   INJECT_BIT(INJECT_KEY_NODE)
#define ID     INJECT_BIT(INJECT_KEY_ID)
#define SKIP   INJECT_BIT(INJECT_KEY_SKIP)
#define FRAMES INJECT_BIT(INJECT_KEY_FRAMES)
#define RATIO  INJECT_BIT(INJECT_KEY_RATIO)
#define SEED   INJECT_BIT(INJECT_KEY_SEED)
#define BY     INJECT_BIT(INJECT_KEY_BY)
#define BY_MM  INJECT_BIT(INJECT_KEY_BY_MM)
#define FOR    INJECT_BIT(INJECT_KEY_FOR)
#define OBJECT INJECT_BIT(INJECT_KEY_OBJECT)
#define VALUE  INJECT_BIT(INJECT_KEY_VALUE)
#define CODE   INJECT_BIT(INJECT_KEY_CODE)
#define REG    INJECT_BIT(INJECT_KEY_REGISTER)
#define WHAT   INJECT_BIT(INJECT_KEY_WHAT)

#define MATCH (NODE | ID | SKIP | FRAMES | RATIO | SEED | FOR)

const struct inject_key_row inject_keys[INJECT_KEYS] = {
    [INJECT_KEY_NODE] = {"node", "1 ... 127 or controller", "who; of frames: who sends them"},
    [INJECT_KEY_ID] = {"id", "a CAN identifier, 0 ... 7FF",
                       "frames with this identifier (default: all)"},
    [INJECT_KEY_SKIP] = {"skip", "a number", "so many matching frames pass first (default: 0)"},
    [INJECT_KEY_FRAMES] = {"frames", "a number from 1, or all",
                           "so many are hit (default: 1; all with for or ratio)"},
    [INJECT_KEY_RATIO] = {"ratio", "0 ... 1",
                          "part of the frames that is hit, of the torque that is left"},
    [INJECT_KEY_SEED] = {"seed", "a number", "of the dice for ratio (default: 1)"},
    [INJECT_KEY_BY] = {"by", "a time such as 300us", "how much later"},
    [INJECT_KEY_BY_MM] = {"by_mm", "a number", "how far, mm or rad"},
    [INJECT_KEY_FOR] = {"for", "a time such as 0.2s", "how long (default: for good)"},
    [INJECT_KEY_OBJECT] = {"object", "INDEX or INDEX:SUB, hexadecimal", "object of the dictionary"},
    [INJECT_KEY_VALUE] = {"value", "a hexadecimal number", "what the object shows"},
    [INJECT_KEY_CODE] = {"code", "a hexadecimal number above 0",
                         "error code of the emergency (16 bits), or SDO abort code"},
    [INJECT_KEY_REGISTER] = {"register", "0 ... FF",
                             "error register of the emergency (default: by the code)"},
    [INJECT_KEY_WHAT] = {"what", "all, heartbeat, tpdo, sdo or emcy",
                         "which frames (default: all)"},
};

const struct inject_kind_row inject_kinds[INJECT_KINDS] = {
    [INJECT_DROP] = {true, "drop", MATCH, 0, "frames that nobody receives"},
    [INJECT_CORRUPT] = {true, "corrupt", MATCH, 0,
                        "frames destroyed on the wire; their sender repeats them"},
    [INJECT_DUPLICATE] = {true, "duplicate", MATCH, 0, "frames received twice"},
    [INJECT_DELAY] = {true, "delay", MATCH | BY, BY, "frames sent later"},
    [INJECT_ERROR_PASSIVE] = {true, "error_passive", NODE, NODE,
                              "the error counter of a node reaches 128"},
    [INJECT_BUS_OFF] = {true, "bus_off", NODE | FOR, NODE, "a node leaves the bus"},
    [INJECT_CUT] = {true, "cut", NODE | FOR, NODE,
                    "the cable to a node breaks: it hears and says nothing"},
    [INJECT_EMCY] = {false, "emcy", CODE | REG, CODE,
                     "the drive fails: emergency, fault reaction, fault"},
    [INJECT_WARN] = {false, "warn", CODE | REG, CODE, "an emergency is sent, the drive goes on"},
    [INJECT_MUTE] = {false, "mute", WHAT | FOR, 0, "frames that are not sent"},
    [INJECT_HANG] = {false, "hang", FOR, 0,
                     "the node sends and takes nothing, its motor does as last told"},
    [INJECT_REBOOT] = {false, "reboot", 0, 0, "the node starts anew, torque off"},
    [INJECT_FREEZE] = {false, "freeze", OBJECT | FOR, OBJECT,
                       "an object keeps showing the value it had"},
    [INJECT_REPORT] = {false, "report", OBJECT | VALUE | FOR, OBJECT | VALUE,
                       "an object shows this value"},
    [INJECT_SDO_ABORT] = {false, "sdo_abort", OBJECT | CODE | FOR, OBJECT | CODE,
                          "SDO requests for an object are aborted"},
    [INJECT_JAM] = {false, "jam", FOR, 0, "the axis is stuck"},
    [INJECT_WEAK] = {false, "weak", RATIO | FOR, RATIO, "the motor has only a part of its torque"},
    [INJECT_ENCODER_JUMP] = {false, "encoder_jump", BY_MM, BY_MM,
                             "the encoder reads more from now on"},
};

static void write_keys(FILE *stream, const struct inject_kind_row *row)
{
    for (unsigned key = 0; key < INJECT_KEYS; key++) {
        if (!(row->allowed & INJECT_BIT(key)))
            continue;
        if (row->required & INJECT_BIT(key))
            (void)fprintf(stream, " %s", inject_keys[key].name);
        else
            (void)fprintf(stream, " [%s]", inject_keys[key].name);
    }
}

static void write_kinds(FILE *stream, bool of_bus)
{
    for (unsigned i = 0; i < INJECT_KINDS; i++) {
        const struct inject_kind_row *row = &inject_kinds[i];
        if (row->of_bus != of_bus)
            continue;
        (void)fprintf(stream, "  %-14s %s\n  %-14s ", row->name, row->meaning, "");
        write_keys(stream, row);
        (void)fputs(row->allowed ? "\n" : " -\n", stream);
    }
}

void inject_write_help(FILE *stream)
{
    (void)fputs(
        "Scripted faults: one a line, # begins a comment.\n"
        "\n"
        "  WHEN           WHERE    FAULT     KEY=VALUE ...\n"
        "  power+50ms     drive 2  emcy      code=4310\n"
        "  enabled+0.5s   bus      drop      id=182 frames=10\n"
        "  enabled+0.5s   bus      corrupt   ratio=0.01 seed=7 for=1s\n"
        "  enabled+2s     drive 1  freeze    object=6041\n"
        "\n"
        "WHEN: power, or enabled, which is when all drives are enabled first; with + and a time\n"
        "in s, ms or us. WHERE: bus (the second: can1), or drive (or io) and its node (of the "
        "second bus: 1:NODE). Identifiers, objects, values "
        "and\n"
        "codes are hexadecimal, other numbers decimal.\n"
        "\nFaults of the bus, with their keys ([key]: may be left out):\n",
        stream);
    write_kinds(stream, true);
    (void)fputs("\nFaults of a drive:\n", stream);
    write_kinds(stream, false);
    (void)fputs("\nKeys:\n", stream);
    for (unsigned key = 0; key < INJECT_KEYS; key++)
        (void)fprintf(stream, "  %-10s %s: %s\n", inject_keys[key].name, inject_keys[key].form,
                      inject_keys[key].meaning);
}
