"""Electronic data sheets of drives with habits that takt's own drive does not have: its sheet, and functions that change it.

A sheet is a dictionary of sections, each a dictionary of keys, in the order of the file."""

import random

PDOS = range(4)


def read(path):
    sheet, section = {}, None
    for line in open(path, encoding="ascii"):
        line = line.strip()
        if line.startswith("["):
            section = sheet.setdefault(line[1:-1], {})
        elif "=" in line:
            key, value = line.split("=", 1)
            section[key] = value
    return sheet


def write(path, sheet):
    with open(path, "w", encoding="ascii") as out:
        for name, keys in sheet.items():
            out.write(f"[{name}]\n" + "".join(f"{key}={value}\n" for key, value in keys.items()) + "\n")
    return path


def drop(sheet, *names):
    """Sections, and with an index its sub-indices."""
    for name in list(sheet):
        if any(name == wanted or name.startswith(wanted + "sub") for wanted in names):
            del sheet[name]


def set_access(sheet, access, *names, default=None):
    for name in names:
        if name in sheet:
            sheet[name]["AccessType"] = access
            if default is not None:
                sheet[name]["DefaultValue"] = default


def no_dummies(sheet, _):
    for key in sheet["DummyUsage"]:
        sheet["DummyUsage"][key] = "0"


def no_event_timer(sheet, _):
    drop(sheet, *(f"180{n}sub5" for n in PDOS))


def no_error_objects(sheet, _):
    drop(sheet, "603F", "60F4")
    map_default(sheet, "1A01", [])


def error_not_mappable(sheet, _):
    sheet["603F"]["PDOMapping"] = sheet["60F4"]["PDOMapping"] = "0"
    map_default(sheet, "1A01", [])


def map_default(sheet, index, objects):
    sheet[index + "sub0"]["DefaultValue"] = str(len(objects))
    for sub in range(1, 9):
        if f"{index}sub{sub}" in sheet:
            sheet[f"{index}sub{sub}"]["DefaultValue"] = f"0x{objects[sub - 1] if sub <= len(objects) else 0:08X}"


def one_entry_a_pdo(sheet, _):
    defaults = {"160": [[0x60400010], [0x607A0020], [], []], "1A0": [[0x60410010], [0x60640020], [], []]}
    for first, pdos in defaults.items():
        for number, objects in enumerate(pdos):
            map_default(sheet, f"{first}{number}", objects)
            drop(sheet, *(f"{first}{number}sub{sub}" for sub in range(2, 9)))
            sheet[f"{first}{number}sub0"]["HighLimit"] = "1"


def short_first_pdos(sheet, _):
    """Room for one object in the first PDOs, and for more in the others; no error code."""
    error_not_mappable(sheet, None)
    for index in ("1600", "1A00"):
        drop(sheet, *(f"{index}sub{sub}" for sub in range(2, 9)))
        sheet[index + "sub0"].update(DefaultValue="1", HighLimit="1")
        sheet[index + "sub1"]["DefaultValue"] = "0x60400010" if index == "1600" else "0x60410010"


def read_only_options(sheet, draw):
    set_access(sheet, "ro", "605E", "605A", "6007", default=draw.choice(["0", "1", "2"]))


def read_only_sync_period(sheet, _):
    set_access(sheet, "ro", "1006", default="0")


def read_only_period(sheet, draw):
    """Of a millisecond, as many drives have it."""
    value, unit = draw.choice([("1", "-3"), ("10", "-4"), ("100", "-5")])
    set_access(sheet, "ro", "60C2sub1", default=value)
    set_access(sheet, "ro", "60C2sub2", default=unit)


def other_period(sheet, _):
    set_access(sheet, "ro", "60C2sub1", default="10")
    set_access(sheet, "ro", "60C2sub2", default="-3")


def narrow_consumer(sheet, _):
    sheet["1016sub1"]["HighLimit"] = "0xFFFF"


def no_consumer(sheet, _):
    drop(sheet, "1016")


def read_only_heartbeat(sheet, draw):
    set_access(sheet, "ro", "1017", default=draw.choice(["0", "100", "1000"]))


def no_heartbeat(sheet, _):
    drop(sheet, "1016", "1017")


def no_life_time(sheet, _):
    """Guarded, but it does not notice when that stays out."""
    drop(sheet, "1016", "1017", "100D")


def short_life_time(sheet, _):
    """It would take any master for lost that asks it as seldom as ours: it is left alone."""
    no_heartbeat(sheet, None)
    set_access(sheet, "ro", "100C", default="10")
    set_access(sheet, "ro", "100D", default="2")


def nobody_watched(sheet, _):
    drop(sheet, "1016", "1017", "100C", "100D")


def fixed_mapping(sheet, _):
    """As CiA 402 has it by default: controlword; controlword and mode; controlword and target; ..."""
    maps = {"1600": [0x60400010], "1601": [0x60400010, 0x60600008], "1602": [0x60400010, 0x607A0020], "1603": [],
            "1A00": [0x60410010], "1A01": [0x60410010, 0x60610008], "1A02": [0x60410010, 0x60640020], "1A03": []}
    for index, objects in maps.items():
        map_default(sheet, index, objects)
        set_access(sheet, "ro", *(f"{index}sub{sub}" for sub in range(9)))
    for number in PDOS:
        sheet[f"140{number}sub1"]["DefaultValue"] = f"$NODEID+0x{0x200 + 0x100 * number:X}"
        sheet[f"180{number}sub1"]["DefaultValue"] = f"$NODEID+0x{0x40000180 + 0x100 * number:X}"


def fixed_small_mapping(sheet, _):
    """Controlword and target in one PDO, statusword and position in one, no mode anywhere."""
    fixed_mapping(sheet, None)
    map_default(sheet, "1600", [0x60400010, 0x607A0020])
    map_default(sheet, "1A00", [0x60410010, 0x60640020])
    drop(sheet, *(f"{first}{n}" for first in ("140", "160", "180", "1A0") for n in (1, 2, 3)))
    sheet["6060"]["PDOMapping"] = "0"


def mode_not_mappable(sheet, _):
    sheet["6060"]["PDOMapping"] = "0"
    sheet["6060"]["AccessType"] = "rw"
    map_default(sheet, "1600", [0x60400010])


def control_not_mappable(sheet, _):
    sheet["6040"]["PDOMapping"] = sheet["6060"]["PDOMapping"] = "0"
    map_default(sheet, "1600", [])
    map_default(sheet, "1602", [])


def interpolated_only(sheet, _):
    sheet["6502"]["DefaultValue"] = "0x61"


def velocity_only(sheet, _):
    sheet["6502"]["DefaultValue"] = "0x120"


def profile_velocity_only(sheet, _):
    sheet["6502"]["DefaultValue"] = "0x25"


def own_ramps(sheet, _):
    """Of 50 turns/s2, as takt's own has them."""
    profile_velocity_only(sheet, None)
    set_access(sheet, "ro", "6083", "6084")


def no_target_position(sheet, _):
    """Its modes say more than can be mapped."""
    sheet["607A"]["PDOMapping"] = sheet["60C1sub1"]["PDOMapping"] = "0"
    for index in ("1601", "1602", "1603"):
        map_default(sheet, index, [])


def no_type(sheet, draw):
    """As data sheets have it that were made in haste."""
    sheet["1000"]["DefaultValue"] = draw.choice(["0", "4", "0x92010200", "0x000F0191", "0x0002FFFF"])


def no_modes(sheet, _):
    drop(sheet, "6502")


def no_modes_and_no_target(sheet, _):
    no_modes(sheet, None)
    no_target_position(sheet, None)


def mapped_all_the_same(sheet, _):
    """The sheet maps it, and says that it cannot be mapped."""
    sheet["607A"]["PDOMapping"] = "0"


def other_sync(sheet, _):
    """By an identifier that somebody has stored."""
    sheet["1005"]["DefaultValue"] = "0x81"


def no_sync_object(sheet, _):
    drop(sheet, "1005", "1019")


def no_mode_display(sheet, _):
    drop(sheet, "6061")
    map_default(sheet, "1A02", [])


def fixed_identifiers(sheet, _):
    set_access(sheet, "ro", *(f"{first}{n}sub1" for first in ("140", "180") for n in PDOS))
    for number in PDOS[2:]:
        sheet[f"140{number}sub1"]["DefaultValue"] = f"$NODEID+0x{0x200 + 0x100 * number:X}"
        sheet[f"180{number}sub1"]["DefaultValue"] = f"$NODEID+0x{0x40000180 + 0x100 * number:X}"


def two_pdos(sheet, _):
    drop(sheet, *(f"{first}{n}" for first in ("140", "160", "180", "1A0") for n in (2, 3)))


def one_pdo(sheet, _):
    drop(sheet, *(f"{first}{n}" for first in ("140", "160", "180", "1A0") for n in (1, 2, 3)))


def targets_at_once(sheet, _):
    """RPDOs that know nothing of SYNC."""
    for number in PDOS:
        sheet[f"140{number}sub2"].update(DefaultValue="255", LowLimit="254", HighLimit="255")


def fixed_telegrams(sheet, _):
    """Of the maker: fields in its order, some that takt knows nothing of, in PDOs that cannot be changed."""
    maps = {"1600": [0x60720010, 0x60600008, 0x60400010], "1601": [0x60710010, 0x607A0020], "1602": [], "1603": [],
            "1A00": [0x60770010, 0x60640020, 0x60410010], "1A01": [0x60610008, 0x603F0010], "1A02": [], "1A03": []}
    for index, objects in maps.items():
        map_default(sheet, index, objects)
        set_access(sheet, "ro", *(f"{index}sub{sub}" for sub in range(9)))
        set_access(sheet, "ro", f"{int(index, 16) - 0x200:04X}sub1")


def reports_at_events(sheet, _, pdos=PDOS):
    """TPDOs that know nothing of SYNC, but have an event timer."""
    for number in pdos:
        sheet[f"180{number}sub2"].update(DefaultValue="255", LowLimit="254", HighLimit="255")


def reports_by_timer(sheet, draw):
    """As the drive has it, once a millisecond."""
    reports_at_events(sheet, draw)
    for number in PDOS:
        set_access(sheet, "ro", f"180{number}sub2", default=draw.choice(["254", "255"]))
        set_access(sheet, "ro", f"180{number}sub5", default="1")


def first_report_at_events(sheet, draw):
    reports_at_events(sheet, draw, PDOS[:1])


def reports_at_changes(sheet, draw):
    """Neither by SYNC nor by a timer: nobody can be asked for more."""
    reports_at_events(sheet, draw)
    no_event_timer(sheet, draw)


def no_options(sheet, _):
    drop(sheet, "6007", "605A", "605B", "605C", "605D", "605E", "1006", "60C2")


# One by one the rows of what real drives do, and what is given up; each boots and runs by itself.
HABITS = {
    "no dummy mapping": (no_dummies, {"pair"}),
    "no event timer": (no_event_timer, {"event_timer"}),
    "603F and 60F4 absent": (no_error_objects, {"error_pdo"}),
    "603F and 60F4 not mappable": (error_not_mappable, {"error_pdo"}),
    "one entry a PDO": (one_entry_a_pdo, {"pair", "mode_pdo", "error_pdo", "one_report"}),
    "one entry in the first PDOs": (short_first_pdos, {"mode_pdo", "error_pdo"}),
    "options read-only": (read_only_options, {"stop_option"}),
    "1006 read-only": (read_only_sync_period, {"sync_period"}),
    "60C2 read-only": (read_only_period, set()),
    "1016 out of range": (narrow_consumer, {"watch"}),
    "1016 absent": (no_consumer, {"watch"}),
    "1017 read-only": (read_only_heartbeat, {"guarded"}),
    "no heartbeat": (no_heartbeat, {"guarded"}),
    "no heartbeat and no life time": (no_life_time, {"guarded", "watch"}),
    "a life time that is too short": (short_life_time, {"heartbeat", "watch"}),
    "neither heartbeat nor guarding": (nobody_watched, {"heartbeat", "watch"}),
    "fixed mapping": (fixed_mapping, {"pair", "mapping", "error_pdo"}),
    "fixed mapping without a mode": (fixed_small_mapping, {"pair", "mapping", "mode_pdo", "error_pdo"}),
    "6060 not mappable": (mode_not_mappable, {"mode_pdo"}),
    "6040 not mappable": (control_not_mappable, {"mode_pdo", "control_pdo"}),
    "interpolated position only": (interpolated_only, {"csp"}),
    "cyclic velocity only": (velocity_only, {"position"}),
    "profile velocity only": (profile_velocity_only, {"position"}),
    "no target position in a PDO": (no_target_position, {"pair", "position"}),
    "1000 of another type": (no_type, {"type"}),
    "6502 absent": (no_modes, {"modes"}),
    "6502 absent, no target position in a PDO": (no_modes_and_no_target, {"modes", "pair", "position"}),
    "607A mapped, though not mappable": (mapped_all_the_same, set()),
    "SYNC by another identifier": (other_sync, set()),
    "1005 absent": (no_sync_object, set()),
    "6061 absent": (no_mode_display, {"mode_display"}),
    "identifiers read-only": (fixed_identifiers, {"pair"}),
    "two PDOs": (two_pdos, set()),
    "one PDO": (one_pdo, {"pair", "mode_pdo", "error_pdo"}),
    "RPDOs without SYNC": (targets_at_once, {"sync_target"}),
    "telegrams of the maker": (fixed_telegrams, {"pair", "mapping", "silence", "error_pdo"}),
    "TPDOs without SYNC": (reports_at_events, {"sync_report"}),
    "TPDOs by a timer of their own": (reports_by_timer, {"sync_report", "event_timer"}),
    "first TPDO without SYNC": (first_report_at_events, set()),
    "nothing optional": (no_options, {"sync_period", "period", "stop_option"}),
}


# Habits of PDOs: a drive has one of them.
OF_PDOS = ("no target position in a PDO", "6502 absent, no target position in a PDO", "one entry a PDO", "one entry in the first PDOs", "fixed mapping", "fixed mapping without a mode", "telegrams of the maker", "6060 not mappable", "6040 not mappable",
           "identifiers read-only", "two PDOs", "one PDO")


def draw_habits(sheet, seed):
    """Some habits of one drive, at random; their names."""
    draw = random.Random(seed)
    names = [name for name in HABITS if name not in OF_PDOS and draw.random() < 0.15]
    if draw.random() < 0.6:
        names.append(draw.choice(OF_PDOS))
    if draw.random() < 0.03:
        names.append("another period")
    for name in names:
        try:
            (HABITS[name][0] if name in HABITS else other_period)(sheet, draw)
        except KeyError:
            pass  # it changes what another one has taken away
    return names
