"""A short hunt with fixed seeds: what must hold of random programs today. The long one is tests/bench/hunt.

Exact path, all kinds of failures: every motion is planned by itself in closed form, its setpoints are evaluated on its
curve, so nothing hangs on a search that may fail. Within a tolerance (G64 P), on the built-in mill: limits, feed, ends
and that no setpoint is outside; the rate along a smoothed curve is bounded by what its own pieces say, and each piece is
looked at before it is handed on, in order: strokes were left out here once. Time of smoothed paths depends on the search,
and is known to fail: it is the long hunt's.
"""

import os
import subprocess
import sys

import takt_test as t

os.environ["HUNT_RUN"] = sys.argv[2]
HUNT = os.path.join(t.SOURCE, "tests", "bench", "hunt")
KINDS = "velocity,acceleration,jerk,outside,corner,order,exact,end,feed,refused,fault,crash"


def hunt(claim, *arguments):
    done = subprocess.run([sys.executable, HUNT, "--judge", sys.argv[1], *arguments], capture_output=True, text=True, check=False)
    t.check(done.returncode == 0, claim, done.stdout, done.stderr)


hunt("exact paths hold on any machine", "30", "1", "--exact")
hunt("smoothed paths hold their limits", "12", "1", "--machines", "builtin", "--kinds", KINDS)
for seed in ("80010", "80068", "80072", "80078", "80086"):
    hunt(f"strokes and loops of a few tolerances are not left out: {seed}", "1", seed, "--operator", "--kinds", KINDS)
hunt("a straight line is as quick within a tolerance as exact", "6", "93301", "--family", "stops", "--kinds", "slow,back,endless")
hunt("a tolerance as large as the part is no standstill", "1", "93051", "--kinds", KINDS + ",endless")
for seed in ("94312", "202802", "206396"):
    hunt(f"where the curve stands it comes to its end: {seed}", "1", seed, "--operator", "--kinds", KINDS + ",endless")
hunt("where it rests before the place that it was thought to be at it goes on from there", "1", "220050", "--kinds", KINDS + ",endless")
for seed in ("251327", "252650"):
    hunt(f"beside a rapid no feed is exceeded: {seed}", "1", seed, "--operator", "--kinds", KINDS)
for seed in ("1100682", "3200970"):
    hunt(f"nor is one on a feed between rapids that is shorter than a piece: {seed}", "1", seed, "--hands", "--kinds", KINDS)
hunt("a curve does not creep where one axis needs a long interval", "1", "901166", "--operator", "--kinds", KINDS + ",endless")
hunt("no way to rest is longer than a cycle's feed where the axes could do far more", "1", "901142", "--operator", "--exact")
hunt("corners of exact paths are not cut where a cycle is long", "1", "40033", "--exact")
for seed in ("921759", "930658"):
    hunt(f"circles of many turns within the tolerance are judged as motions, not as pieces: {seed}", "1", seed, "--operator")
hunt("a chain that ends with a motion of the path itself comes to rest there", "1", "934887", "--operator", "--kinds", KINDS)
hunt("motions of the path itself keep the feed where rotary axes move too", "1", "920587", "--operator", "--kinds", KINDS)
hunt("a rotary axis alone, rounded into linear ones, keeps its feed", "1", "1070140", "--hands", "--kinds", KINDS)
for seed in ("1070690", "1070701", "1080141", "1082075"):
    hunt(f"a hold while the axes speed up after another exceeds no feed: {seed}", "1", seed, "--hands", "--kinds", KINDS)
hunt("motions of the path itself pass corners within a tolerance below the chord error", "1", "3302434", "--operator")
hunt("a hold runs into no block of a lower feed faster than that", "1", "4100032", "--operator")
hunt("a thousand cycles of braking end no harder for rounding", "1", "3304948", "--operator")
hunt("units of path do not show in the acceleration of a slow rotary axis", "1", "3203788", "--hands")
hunt("a motion of the path itself behind one that was told already is a part of that, by override", "1", "3103708", "--operator")
hunt("and by single block", "1", "3201813", "--hands")
hunt("a window has all places that its samples may be at, where an axis reaches its velocity at once", "1", "5501675", "--kinds", KINDS)
hunt("lines through setpoints leave no arc by more than the tolerance", "1", "7700645", "--kinds", KINDS)
hunt("single block and holds at any cycle break nothing", "12", "1060001", "--hands", "--kinds", KINDS)
hunt("nor does the end of a run at any", "12", "3600001", "--ends", "--kinds", KINDS)
t.finish()
