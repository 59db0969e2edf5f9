"""A casting of uneven height is faced: the spindle's load, computed anew from the trace, is held at its limit by the feed."""

import os

import takt_test as t

PROGRAM, MACHINE, STOCK = (os.path.join(t.EXAMPLES, "casting." + end) for end in ("ngc", "ini", "stock"))
PASSES = 7, 11  # lines of the program
CYCLE_S = 0.001
FEED = 1200.0  # programmed, mm/min
# Of casting.ini and the built-in spindle: N/mm2, mm, N m, N m s/rad.
FORCE, WIDTH, RATED, FRICTION = 700.0, 24.0, 0.875, 2e-5
LIMIT = 100.0
FALL_S = 0.5  # the feed falls by (load/limit - 1) / FALL_S a second
SPAN = 20  # cycles over which speed and feed are taken


def read_stock():
    with open(STOCK) as file:
        rows = [[float(word) for word in line.split("#")[0].split()] for line in file]
    xs, *rest = [row for row in rows if row]
    return xs, [row[0] for row in rest], [row[1:] for row in rest]


def depth(stock, x, y, z):
    """Sum of the four tops around, each weighted by the area opposite to it."""
    xs, ys, tops = stock
    if not (xs[0] <= x <= xs[-1] and ys[0] <= y <= ys[-1]):
        return 0.0
    i = max(n for n in range(len(xs) - 1) if xs[n] <= x)
    k = max(n for n in range(len(ys) - 1) if ys[n] <= y)
    area = (xs[i + 1] - xs[i]) * (ys[k + 1] - ys[k])
    top = sum(tops[k + b][i + a] * abs(x - xs[i + 1 - a]) * abs(y - ys[k + 1 - b]) for a in (0, 1) for b in (0, 1)) / area
    return max(0.0, top - z)


def run(*options):
    """Of every cycle of the passes: X, Y, feed in mm/min and load in percent, by k_c a_e a_p v_f / omega + friction."""
    status, _, err = t.run("run", PROGRAM, "--machine", MACHINE, "--stock", STOCK, "--quiet", "--json", "run.json", "--trace", "trace.csv", *options)
    t.check(status == 0, "every limit is held", options, err)
    trace = t.read_trace("trace.csv")
    stock = read_stock()
    rows = []
    turned = trace["spindle_rev"]
    for n in range(SPAN, len(turned)):
        if not PASSES[0] <= trace["line"][n] <= PASSES[1]:
            continue
        omega = abs(turned[n] - turned[n - SPAN]) * t.math.tau / (SPAN * CYCLE_S)
        x, y, z, feed = (trace[name][n] for name in ("cmd_X_mm", "cmd_Y_mm", "cmd_Z_mm", "feed_mm_min"))
        power = FORCE * WIDTH * depth(stock, x, y, z) * feed / 60 * 1e-3
        rows.append((x, y, feed, 100 * (power / omega + FRICTION * omega) / RATED))
    return rows, t.load_json("run.json")


free, summary = run("--set", "spindle.load_limit_percent=0")
full_s = summary["program_time_s"]
peak = max(load for _, _, _, load in free)
t.check(135 < peak < 152, "at full feed the deepest cut is far too much", peak)

held, summary = run()
for name, rows, seconds in ("none", free, full_s), ("100 %", held, summary["program_time_s"]):
    level = [load for x, _, _, load in rows if abs(x) < 15]
    print(f"limit {name}: at most {max(row[3] for row in rows):.1f} %, where the casting is level {min(level):.1f} to {max(level):.1f} %, {seconds:.1f} s")
t.check(max(row[3] for row in held) < 1.15 * LIMIT, "with the limit it is passed by little, while the cut gets deeper", max(row[3] for row in held))
t.check(summary["program_time_s"] > full_s + 2, "at the cost of time", summary["program_time_s"], full_s)
# In the middle of each pass the casting is level in X: the load comes to rest at its limit.
for middle in -24, 0, 24:
    loads = [load for x, y, _, load in held if abs(x) < 15 and abs(y - middle) < 0.01]
    t.check(len(loads) > 500 and all(abs(load - LIMIT) < 1.5 for load in loads), f"Y{middle}: the load is held at its limit", min(loads), max(loads))
    feeds = [feed for x, y, feed, _ in held if abs(x) < 15 and abs(y - middle) < 0.01]
    t.check(max(feeds) < 0.85 * FEED, f"Y{middle}: by the feed", max(feeds))
# Where the cut gets deeper: load/limit - 1 = -FALL_S dr/dt, r the feed as a part of the programmed one.
worst = 0.0
for n in range(SPAN, len(held) - SPAN):
    rate = (held[n + SPAN][2] - held[n - SPAN][2]) / FEED / (2 * SPAN * CYCLE_S)
    if held[n][3] > 1.03 * LIMIT and 45 < abs(held[n][0]) < 80:
        worst = max(worst, abs(held[n][3] / LIMIT - 1 + FALL_S * rate))
t.check(0 < worst < 0.03, "it is passed by as much as the law of the feed says", worst)
# And where it is shallow the feed is what the program says.
shallow = [feed for x, y, feed, _ in held if 118 < x < 125 and abs(y) in (24, 0)]
t.check(len(shallow) > 500 and min(shallow) > FEED - 1, "the feed comes back", min(shallow))

# Overloaded for longer than its drive bears it, the spindle stands in the material; a stock that is cut with the limit does not.
bears = ("--set", "spindle.overload_s=2", "--stock", STOCK, "--quiet", "--json", "trip.json")
for limit, trip in (("0", 5), ("100", 0)):
    status, _, err = t.run("run", PROGRAM, "--machine", MACHINE, "--set", f"spindle.load_limit_percent={limit}", *bears)
    check = [check for check in t.load_json("trip.json")["checks"] if check["name"] == "spindle_trip"]
    t.check(len(check) == 1 and check[0]["value"] == trip, "a spindle that trips is told", limit, check)
    t.check(status == (1 if trip else 0), "and the run ends as one that has failed", limit, status, err)

for text, place, said in (
    ("0 10\n0 1 2\n", ":3:", "two rows"),
    ("0\n0 1\n1 1\n", ":1:", "two columns"),
    ("0 10\n0 1\n", ":2:", "a number is missing"),
    ("0 10\n0 1 2 3\n", ":2:7", "and no more"),
    ("0 10 10\n", ":1:6", "must rise"),
    ("0 10\n0 1 2\n0 1 2\n", ":3:1", "must rise"),
    ("0 10\n0 1 top\n", ":2:5", "not a number"),
    ("0 10\n0 1 inf\n", ":2:5", "not a number"),
    ("", ":1:", "a line of X"),
):
    t.write("wrong.stock", text)
    status, _, err = t.run("run", PROGRAM, "--stock", "wrong.stock")
    t.check(status == 2 and "wrong.stock" + place in err and said in err, "a wrong stock is told with its place", text, status, err)
status, _, err = t.run("run", PROGRAM, "--stock", "missing.stock")
t.check(status != 0 and "missing.stock" in err, "a stock that is not there is told", status, err)
t.finish()
