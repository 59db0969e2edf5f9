"""The most stack that an image can use: frames of its functions, along the longest way through its calls.

Frames and calls are read from the disassembly, so libraries count, too; where the compiler has told a frame (-fstack-usage)
the larger counts. Calls through pointers are those of the table below: who calls, and what may be behind the pointer. A
call that is in no row, and a recursion without a stated bound, are errors. The table's names are without takt_.
"""

import collections
import re
import subprocess

# Processor state that an interrupt saves: 26 words with the floating-point unit, and a word to align.
EXCEPTION_BYTES = 27 * 4

# Values inside values of a part program: PROGRAM_NESTING_MAX, and one more for the outermost. One function counts them.
NESTING = 17
NESTED = "takt_expression_read"

PORT = r"(cortex_)?(un)?lock|now_us|now_ns|reply|write_log"
LAYER = r"(axes|matrix|setup|volume|thermal|wear)_(add|begin|follow|need|prepare)"
CODES = (r"(events|modes|coordinates|cutter(?!_compensation)|cycles|straight|circular|involute|probe|saved_modes|setting|threading|spline)_.*"
         r"|calls_run_code")
OPERATORS = (r"function_.*|add|subtract|multiply|divide|modulo|power|equal|not_equal|greater|greater_or_equal|less"
             r"|less_or_equal|logic_.*")
STORE = r"begin|begin_stream|bring|prepare|place|room|end|look|order|hear|settings_.*|may_load"
CALLS = (
    (r"axes_add|axes_need", r"geometry_.*"),  # no machine of a target has errors of units
    (r"answer_.*|modbus_answer", r"panel_read|panel_write"),
    (r".*_layers?|exchange_.*|weigh|correction_.*", LAYER),
    (r"comment_run", r"say"),  # nobody listens on a target
    (r"controller_background", r"refuse_line"),
    (r"decimal_read", r"wide_.*"),
    (r"embedded_.*|hear|order|log_.*|serve_line|refuse|forward|lock|unlock", PORT),
    (r"expression_.*|read_.*", OPERATORS),
    (r"fill.*|has", r"read_bytes|text_read"),
    (r"findings_next", r"find_.*"),
    (r"lexer_.*", r"seek|text_seek|read_bytes|text_read"),
    (r"flow_.*", r"take_(do|else|elseif|endif|endrepeat|endwhile|if|repeat|while)|calls_.*|leave_round"),
    (r"give_order|decide|panel_(?!look).*", STORE),
    (r"panel_look", r"look|hear"),
    (r"predefined_.*", r"get_.*"),
    (r"refuse_line", r"lines_refuse"),  # nobody has a console on a target
    (r"replay_read|intake_.*", r"take|is_lost"),
    (r"run_line|run_step.*", CODES),
    (r"send_.*", r"send"),
    (r"begin|take|prepare|place", r"drives_are_off|write_log|borrow_tables"),
    (r"store_.*", r"erase|program"),
    (r"usart_interrupt", r"take_(panel|log)_byte"),
    (r"drives_.*", r"receive|send|sdo_.*"),
    (r"receive", r"slcan_can_take|take_panel_byte"),
    (r"service_.*", r"text_queue_.*|open|announce|forget"),
    (r"steps_.*|read_encoders", r"step_.*"),
    # The image of a drive, to which nobody listens, and with which no test meddles.
    (r"servo_tell|servo_read_row|find", r"nobody"),
    (r"servo_send", r"send"),
    (r"sdo_server_.*", r"send_sdo|servo_(read|may_write|write)_sdo"),
    (r"set_stored|servo_take_lss", r"keep"),
    (r"drive_node_cycle|main", r"receive"),
    (r"turn|look", r"turn_axis|sense_axis"),
    (r"turn_axis|sense_axis", r"turn_motor|sense_motor"),
)

FUNCTION = re.compile(r"^([0-9a-f]+) <(.+)>:$")
INSTRUCTION = re.compile(r"^\s+[0-9a-f]+:\s+(\S+)\s*(.*)$")
TARGET = re.compile(r"\b([0-9a-f]+) <([^+>]+)>")
INDIRECT = re.compile(r"^(r\d+|ip|sl|fp|r9)\b")


class Function:
    def __init__(self):
        self.frame = 0
        self.calls = set()
        self.indirect = False
        self.begins_anew = False


def registers(text):
    count = 0
    for part in re.search(r"\{(.*)\}", text).group(1).split(","):
        ends = re.findall(r"[a-z]+(\d+)", part) if "-" in part else []
        count += int(ends[1]) - int(ends[0]) + 1 if ends else 1
    return count


def frame_bytes(operation, text):
    if operation in ("push", "push.w") or (operation.startswith("stmdb") and text.startswith("sp!")):
        return 4 * registers(text)
    if operation == "vpush":
        return (8 if "d" in re.search(r"\{(.*)\}", text).group(1) else 4) * registers(text)
    pushed = re.match(r"(?:sp, )?sp, #(\d+)", text) if operation.startswith("sub") else None
    pushed = pushed or (re.match(r"sp, #(\d+)", text) if operation.startswith("sub") else None)
    stored = re.search(r"\[sp, #-(\d+)\]!", text)
    return int((pushed or stored).group(1)) if pushed or stored else 0


def name_functions(lines):
    """Names by address: of several of one name each has its address behind a point."""
    begun = [match.groups() for match in map(FUNCTION.match, lines) if match]
    count = collections.Counter(name for _, name in begun)
    return {int(at, 16): name if count[name] == 1 else f"{name}.{int(at, 16):x}" for at, name in begun}


def read_functions(elf):
    out = subprocess.run(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", elf], capture_output=True, text=True, check=True).stdout
    lines = out.splitlines()
    names = name_functions(lines)
    functions, name = {}, None
    for line in lines:
        begun, done = FUNCTION.match(line), INSTRUCTION.match(line)
        if begun:
            name = names[int(begun.group(1), 16)]
            functions[name] = Function()
        elif done and name:
            read_instruction(functions[name], name, names, *done.groups())
    return functions


def read_instruction(function, name, names, operation, text):
    function.frame += frame_bytes(operation, text)
    target = TARGET.search(text)
    if operation == "mov" and text.startswith("sp, r"):
        function.begins_anew = True
    if function.begins_anew:
        return  # what it calls has the whole stack again, and never comes back
    if operation in ("bl", "blx", "b", "b.w", "b.n") and target:
        callee = names.get(int(target.group(1), 16), target.group(2))
        if callee != name:
            function.calls.add(callee)
    if operation in ("blx", "bx") and INDIRECT.match(text):
        function.indirect = True


def add_usage(functions, files):
    """What the compiler has told."""
    for path in files:
        with open(path) as file:
            for line in file:
                place, size, _ = line.rstrip("\n").split("\t")
                name = place.rsplit(":", 1)[1]
                for known in (known for known in functions if known == name or known.startswith(name + ".")):
                    functions[known].frame = max(functions[known].frame, int(size))


def plain(name):
    """As the table has it: without an address behind it, and without the prefix that the linker sees."""
    return re.sub(r"\..*", "", name).removeprefix("takt_")


def add_pointers(functions):
    """Calls through pointers, by the table. Returns the names of those that are in no row."""
    unknown = []
    for name, function in functions.items():
        if not function.indirect:
            continue
        rows = [behind for caller, behind in CALLS if re.fullmatch(caller, plain(name))]
        if not rows:
            unknown.append(name)
        for behind in rows:
            function.calls.update(other for other in functions if re.fullmatch(behind, plain(other)))
    return unknown


def circles(functions):
    """Sets of functions that call one another in a circle, callees first (Tarjan, without recursion)."""
    index, low, on, stack, found = {}, {}, set(), [], []
    for root in functions:
        if root in index:
            continue
        work = [(root, iter(sorted(functions[root].calls)))]
        index[root] = low[root] = len(index)
        stack.append(root)
        on.add(root)
        while work:
            name, calls = work[-1]
            for callee in calls:
                if callee not in functions:
                    continue
                if callee not in index:
                    index[callee] = low[callee] = len(index)
                    stack.append(callee)
                    on.add(callee)
                    work.append((callee, iter(sorted(functions[callee].calls))))
                    break
                if callee in on:
                    low[name] = min(low[name], index[callee])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[name])
                if low[name] == index[name]:
                    circle = set()
                    while name not in circle:
                        circle.add(stack.pop())
                    on -= circle
                    found.append(circle)
    return found


def once_around(functions, circle):
    """The most stack of one turn of a circle whose turns a function counts; None: there is another circle in it."""
    most, open_ones = {}, set()

    def visit(name):
        if name in most:
            return most[name]
        if name in open_ones:
            return None
        open_ones.add(name)
        below = [visit(callee) for callee in functions[name].calls & circle if callee != NESTED]
        open_ones.discard(name)
        most[name] = None if None in below else functions[name].frame + max(below, default=0)
        return most[name]

    return visit(NESTED) if NESTED in circle else None


def deepest(functions):
    """The most stack below and with each function, the way there, and circles without a bound."""
    depth, way, unbounded = {}, {}, []
    for circle in circles(functions):
        own = sum(functions[name].frame for name in circle)
        if len(circle) > 1 or any(name in functions[name].calls for name in circle):
            turn = once_around(functions, circle)
            if turn is None:
                unbounded.append(sorted(circle))
            own = NESTING * (turn or own)
        below = {callee for name in circle for callee in functions[name].calls if callee in depth and callee not in circle}
        most = max(below, key=depth.get, default=None)
        for name in circle:
            depth[name] = own + (depth[most] if most else 0)
            way[name] = most
    return depth, way, unbounded


def path(way, name):
    steps = []
    while name:
        steps.append(name)
        name = way[name]
    return steps
