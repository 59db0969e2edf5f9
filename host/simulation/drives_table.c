#include "simulation/drives_table.h"

#include "canopen/sdo.h"

#include <string.h>

#define IDENTITY                                                                                   \
    "look at drive_node and the node ids of the drives; drive_vendor, drive_product, "             \
    "drive_revision and drive_serial say what is expected"
#define IO_WIRING "look at its power, bit rate and termination, and at node in its section [io N]"
#define IO_DEFAULTS                                                                                \
    "give the node the defaults of its maker (object 1011), or wire fewer bits in its section "    \
    "[io N]"

/* In the order of enum drives_given_up. */
static const struct {
    const char *name;   /* in JSON */
    const char *object; /* that is not as takt would have it */
    const char *follows;
} rows[DRIVES_GIVEN_UP_COUNT] = {
    [DRIVES_NO_PAIR] = {"pair", "1601", "no dummy mapping: its target has a frame of its own"},
    [DRIVES_NO_MAPPING] = {"mapping", "1600 1A00",
                           "the mapping cannot be changed: PDOs are used as they are"},
    [DRIVES_NO_SILENCE] = {"silence", "1800", "sends PDOs that nobody needs, which load the bus"},
    [DRIVES_NO_ONE_REPORT] = {"one_report", "6041 6064",
                              "not in one PDO: two frames in every cycle"},
    [DRIVES_NO_CSP] = {"csp", "6502",
                       "interpolated position mode instead of cyclic synchronous position"},
    [DRIVES_NO_MODES] = {"modes", "6502",
                         "does not tell its modes: cyclic synchronous position is tried"},
    [DRIVES_NO_MODE_PDO] = {"mode_pdo", "6060", "not in a PDO: the mode is told by SDO"},
    [DRIVES_NO_CONTROL_PDO] = {"control_pdo", "6040",
                               "not in a PDO: the controlword is told by SDO, a stop comes later"},
    [DRIVES_NO_MODE_DISPLAY] = {"mode_display", "6061", "cannot be read: the mode is believed"},
    [DRIVES_NO_SYNC_TARGET] =
        {"sync_target", "1401:02",
         "the target acts when it comes, not with SYNC: axes are less simultaneous"},
    [DRIVES_NO_ERROR_PDO] = {"error_pdo", "603F",
                             "not in a PDO: a lost emergency leaves a fault without a code"},
    [DRIVES_NO_EVENT_TIMER] = {"event_timer", "1801:05",
                               "the error code is told once, when it changes"},
    [DRIVES_NO_HEARTBEAT] = {"heartbeat", "1017", "the drive is watched by its status alone"},
    [DRIVES_NO_WATCH] = {"watch", "1016",
                         "the drive does not notice when the controller falls silent"},
    [DRIVES_NO_SYNC_PERIOD] = {"sync_period", "1006",
                               "the drive may not notice when SYNC stays out"},
    [DRIVES_NO_PERIOD] = {"period", "60C2", "the drive is not told the time between targets"},
    [DRIVES_NO_STOP_OPTION] = {"stop_option", "6007 605A 605E", "the drive stops as it is set up"},
    [DRIVES_NO_HOMING_SPEED] = {"homing_speed", "6099 609A",
                                "the drive homes as fast as it is set up"},
    [DRIVES_NO_TOUCH_PROBE] = {"touch_probe", "60B8",
                               "no touch probe: a probing move has the position of a cycle"},
    [DRIVES_NO_SCALING] = {"scaling", "608F 6091 6092",
                           "is not told: increments_per_mm is believed"},
    [DRIVES_NO_POSITION] = {"position", "6502",
                            "a mode of velocity: the controller closes the position loop"},
    [DRIVES_NO_RAMPS] = {"ramps", "6083 6084", "the drive goes to a velocity as it is set up"},
    [DRIVES_NO_TYPE] = {"type", "1000", "the type is not that of a drive: it is taken for one"},
    [DRIVES_NO_SYNC_REPORT] =
        {"sync_report", "1800:02",
         "reports by its timer (1800:05), not by SYNC: positions are up to a cycle older"},
    [DRIVES_GUARDED] = {"guarded", "1017", "no heartbeat: the drive is asked for its state (100C)"},
};

void drives_table_set(struct drives_table *table, const struct drives *drives)
{
    memset(table, 0, sizeof *table);
    for (unsigned i = 0; i < AXIS_COUNT; i++)
        table->given_up[i] = takt_drives_get_given_up(drives, (enum axis)i);
    for (unsigned bus = 0; bus < CAN_BUSES_MAX && drives_get_state(drives) != DRIVES_STARTING;
         bus++)
        takt_drives_get_load(drives, bus, &table->load[bus]);
}

bool drives_table_has(const struct drives_table *table, enum drives_given_up what)
{
    uint32_t any = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        any |= table->given_up[i];
    return any >> what & 1;
}

static bool has_row(const struct drives_table *table, unsigned axis, unsigned row)
{
    return table->given_up[axis] >> row & 1;
}

static void write_row(FILE *stream, const struct drives_table *table, unsigned row,
                      const char *head)
{
    char axes[AXIS_COUNT + 1];
    unsigned count = 0;

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        if (has_row(table, i, row))
            axes[count++] = AXIS_LETTERS[i];
    axes[count] = '\0';
    (void)fprintf(stream, "  %-14s%-7s %-15s %s\n", head, axes, rows[row].object,
                  rows[row].follows);
}

void drives_table_write_text(FILE *stream, const struct drives_table *table)
{
    const char *head = "given up";

    for (unsigned row = 0; row < DRIVES_GIVEN_UP_COUNT; row++) {
        if (!drives_table_has(table, (enum drives_given_up)row))
            continue;
        write_row(stream, table, row, head);
        head = "";
    }
}

void drives_table_write_bits(FILE *stream, uint32_t given_up)
{
    for (unsigned row = 0; row < DRIVES_GIVEN_UP_COUNT; row++)
        if (given_up >> row & 1)
            (void)fprintf(stream, "  %-15s %s\n", rows[row].object, rows[row].follows);
}

bool drives_table_tell(const struct drives *drives, bool is_quiet)
{
    struct drives_table table;

    if (drives_get_state(drives) != DRIVES_ENABLED)
        return false;
    drives_table_set(&table, drives);
    if (!is_quiet)
        drives_table_write_text(stderr, &table);
    return true;
}

static void add_drive(cJSON *drives, const struct drives_table *table, unsigned axis, unsigned node)
{
    const char letter[] = {AXIS_LETTERS[axis], '\0'};
    cJSON *drive = cJSON_CreateObject();

    cJSON_AddStringToObject(drive, "axis", letter);
    cJSON_AddNumberToObject(drive, "node", node);
    cJSON *given_up = cJSON_AddArrayToObject(drive, "given_up");

    for (unsigned row = 0; row < DRIVES_GIVEN_UP_COUNT; row++)
        if (has_row(table, axis, row))
            cJSON_AddItemToArray(given_up, cJSON_CreateString(rows[row].name));
    cJSON_AddItemToArray(drives, drive);
}

void drives_table_add_json(cJSON *root, const struct drives_table *table,
                           const struct machine *machine)
{
    cJSON *drives = cJSON_AddArrayToObject(root, "drives");

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        if (machine_axis_is_on_can(&machine->axis[i]))
            add_drive(drives, table, i, machine->axis[i].drive_node);
}

/* What helps after a fault: the first row that fits. */
static const struct remedy {
    enum takt_error code;
    const char *objects; /* NULL: whichever it is */
    bool is_absent;      /* the drive does not have the object, in some of its forms */
    const char *text;
} remedies[] = {
    {TAKT_ERROR_DRIVE_ABSENT, NULL, false,
     "look at its power, node id, bit rate and termination; if it boots more slowly, make "
     "boot_timeout_ms in [bus] longer"},
    {TAKT_ERROR_DRIVE_UNANSWERED, NULL, false,
     "if it answers more slowly, make sdo_timeout_ms in [bus] longer, if it boots more slowly, "
     "boot_timeout_ms"},
    {TAKT_ERROR_DRIVE_TYPE, NULL, false, IDENTITY},
    {TAKT_ERROR_DRIVE_IDENTITY, NULL, false, IDENTITY},
    {TAKT_ERROR_DRIVE_MODES, NULL, false,
     "choose a firmware or set-up of the drive with mode 8, 7, 9 or 3, since profile position (1) "
     "comes to rest at every target and velocity of converters (2) knows whole rpm alone; "
     "home_order = 0 for a drive that cannot home"},
    {TAKT_ERROR_DRIVE_NOT_ENABLED, NULL, false,
     "look at its power stage, enable and safe torque off (STO) inputs, and at its manual on what "
     "it waits for; if it takes longer over that, make boot_timeout_ms in [bus] as long"},
    {TAKT_ERROR_DRIVE_HEARTBEAT, NULL, false,
     "look at its cable and power; if it takes no such period in 1017, make heartbeat_ms in [bus] "
     "longer"},
    {TAKT_ERROR_DRIVE_REBOOTED, NULL, false,
     "look at its supply; its axis has to find its home again if its encoder counts from power-on"},
    {TAKT_ERROR_DRIVE_SILENT, NULL, false,
     "look at its cable and power; if it has never sent one, at its first TPDO (1800, 1A00) and at "
     "SYNC (1005)"},
    {TAKT_ERROR_DRIVE_STATE, NULL, false,
     "look at the supply of its power stage, at its enable and safe torque off (STO) inputs"},
    {TAKT_ERROR_DRIVE_MODE, NULL, false,
     "look at the set-up of the drive, objects 6060 and 6502; one that changes its mode without "
     "torque alone cannot be homed from here: home_order = 0"},
    {TAKT_ERROR_DRIVE_REFUSES, "6083 6084", false,
     "set velocity_units_per_mm_s to the unit of the drive (rpm: 60 by the travel of a turn), make "
     "max_acceleration_mm_s2 lower, or these ramps steeper with the maker's tool"},
    {TAKT_ERROR_DRIVE_REFUSES, NULL, false,
     "set it up with the maker's tool; homing is home_order, home_method and home_offset_mm"},
    {TAKT_ERROR_DRIVE_UNMAPPED, "6041 6064", false,
     "map it with the maker's tool into a TPDO that is valid, has an identifier with the drive's "
     "node id (180, 280, 380 or 480 + node), and is of transmission type 1 or with an event timer "
     "(1800:05) of the cycle, and store that; a drive that has it for no PDO cannot be used"},
    {TAKT_ERROR_DRIVE_UNMAPPED, NULL, true,
     "choose a drive, or with the maker's tool a mode or a firmware, that has a target position "
     "(607A) or velocity (60FF) and 6041 and 6064 for its PDOs"},
    {TAKT_ERROR_DRIVE_UNMAPPED, NULL, false,
     "map it with the maker's tool into a PDO that is valid and of transmission type 1, and store "
     "that"},
    {TAKT_ERROR_DRIVE_SHARES, NULL, false,
     "give each drive a PDO with an identifier of its own with the maker's tool, or "
     "drive_is_set_up = 0"},
    {TAKT_ERROR_DRIVE_UNWATCHED, NULL, false,
     "set up its consumer heartbeat (1016) or guarding (100C and 100D) with the maker's tool; "
     "heartbeat_ms in [bus] must not be 0"},
    {TAKT_ERROR_DRIVE_PERIOD, NULL, false,
     "set cycle_us in [machine] to that time, or 60C2 with the maker's tool"},
    {TAKT_ERROR_DRIVE_SCALING, NULL, false,
     "correct increments_per_mm or travel_per_turn_mm, or objects 608F, 6091 and 6092 with the "
     "maker's tool"},
    {TAKT_ERROR_DRIVE_FOLLOWING, NULL, false,
     "look at increments_per_mm and the gains of the drive; what it cannot follow is too much for "
     "it: max_acceleration_mm_s2, max_velocity_mm_s; a drive has limits of its own (607D), and "
     "positions that wrap (607B) are none"},
    {TAKT_ERROR_DRIVE_SKEW, NULL, false,
     "look at the switches of both drives, and at home_offset_mm and skew_max_mm in [gantry]"},
    {TAKT_ERROR_IO_ABSENT, NULL, false, IO_WIRING},
    {TAKT_ERROR_IO_TYPE, NULL, false, IO_WIRING},
    {TAKT_ERROR_IO_UNANSWERED, NULL, false, IO_WIRING},
    {TAKT_ERROR_IO_REFUSES, NULL, false, IO_DEFAULTS},
    {TAKT_ERROR_IO_UNMAPPED, NULL, false, IO_DEFAULTS},
    {TAKT_ERROR_BUS_OVERLOAD, NULL, false,
     "make cycle_us in [machine] longer, or bitrate in [bus] higher"},
};

/* Is the object of the fault, "object 6083:00", one of these? */
static bool is_one_of(const struct diagnostic *fault, const char *objects)
{
    const char *object = strstr(fault->word, "object ");
    char index[5] = "";

    if (object != NULL)
        (void)snprintf(index, sizeof index, "%.4s", object + strlen("object "));
    return index[0] != '\0' && strstr(objects, index) != NULL;
}

const char *drives_table_remedy(const struct diagnostic *fault)
{
    for (size_t i = 0; i < sizeof remedies / sizeof remedies[0]; i++) {
        const struct remedy *row = &remedies[i];

        if (fault->code == row->code && (row->objects == NULL || is_one_of(fault, row->objects)) &&
            (!row->is_absent || sdo_says_absent((uint32_t)fault->value)))
            return row->text;
    }
    return "";
}
