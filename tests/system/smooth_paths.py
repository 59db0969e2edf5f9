"""takt run of smoothed paths (G64 P) that are hard to get through, and on machines of all stiffnesses."""

import os

import takt_test as t

# Arcs hardly wider than the tolerance, over each other. Slowed down again and again, the curve came no nearer to the end
# of what was known of the path.
LOOPS = """G21 G90 G17
G64 P0.0698 Q0.01391
F6000
G3 X-0.04281 Y0.47727 Z-0.0661 I0.02115 J0.24245
G3 X-0.20136 Y0.40919 Z-0.0661 I-0.06495 J-0.06741
G3 X-0.68290 Y0.31056 Z-0.0661 I-0.32254 J0.42763
G3 X-1.55415 Y0.24196 Z-0.1447 I-0.45090 J0.15974
G64 P0.13761
G2 X-1.32013 Y0.36609 Z-0.1453 I-0.05457 J0.42164
G3 X-0.81386 Y0.42548 Z-0.1221 I0.24215 J0.07262
G3 X-0.71871 Y0.56637 Z-0.1221 I-0.07351 J0.12640
G2 X-0.20989 Y0.30561 Z-0.1040 I0.16032 J-0.31016
G3 X-0.36149 Y0.29316 Z-0.1060 I-0.07306 J-0.03954
G2 X-0.23000 Y0.10074 Z-0.2079 I0.01504 J-0.13620
G2 X-0.04843 Y0.19453 Z-0.2711 I0.08127 J0.06532
G2 X-0.34824 Y0.22518 Z-0.2711 I-0.12842 J0.22552
G3 X-0.29678 Y0.32299 Z-0.2711 I0.11237 J0.00332
G3 X-0.25851 Y0.31611 Z-0.2711 I0.02184 J-0.03538
G2 X-0.29176 Y0.28827 Z-0.2711 I0.08634 J-0.13689
G3 X-0.27508 Y0.26959 Z-0.3479 I0.01974 J0.04481
G3 X-0.28507 Y0.22276 Z-0.3091 I-0.01186 J-0.01860
G2 X-0.24594 Y0.19477 Z-0.2554 I0.07896 J0.06903
G3 X-0.47306 Y-0.07386 Z-0.2554 I-0.24987 J-0.01907
G3 X0.48444 Y0.23685 Z-0.1722 I0.44507 J0.22080
G3 X-0.03114 Y-0.08379 Z-0.1083 I-0.22512 J-0.20231
G2 X-0.15146 Y0.23170 Z-0.1083 I-0.06277 J0.15675
M2
"""

# Bends of a few tolerances: the curve may be near the path everywhere and cut an end of a motion off.
BENDS = """G21 G90 G17
G64 P0.27209
F6000
G3 X-0.04486 Y-0.01639 Z0.0000 I-0.01897 J-0.01765
G2 X0.49620 Y-1.08685 Z0.0886 I-0.26075 J-0.80376
G3 X2.26029 Y-3.42080 Z0.0886 I0.22645 J-1.66250
G2 X2.00105 Y-3.55564 Z0.0524 I-0.21355 J0.09911
G2 X2.41195 Y-5.35830 Z-0.4118 I-0.57217 J-1.07858
G3 X2.46324 Y-5.44883 Z-0.4118 I-0.49517 J-0.34033
G3 X2.43323 Y-5.50449 Z-0.4118 I-0.02283 J-0.02361
G3 X2.93822 Y-5.60330 Z-0.6063 I0.26239 J-0.05931
G2 X3.02342 Y-5.77967 Z-0.6063 I0.03591 J-0.09558
G2 X2.97101 Y-5.71767 Z-0.6063 I-0.02515 J0.03190
G3 X2.66131 Y-4.88950 Z-0.7185 I-0.00918 J0.46856
G2 X2.31949 Y-4.74011 Z-1.0332 I-0.18311 J0.04678
G3 X2.15832 Y-4.67476 Z-1.0332 I-0.10004 J-0.01530
G3 X2.11109 Y-4.75840 Z-1.0000 I-0.06763 J-0.01696
G3 X1.61200 Y-4.50823 Z-1.0000 I-0.32890 J-0.04240
G2 X1.71840 Y-4.77004 Z-0.8989 I0.01593 J-0.14819
G2 X1.71701 Y-4.69114 Z-0.8989 I-0.00127 J0.03944
G2 X1.67621 Y-4.61688 Z-0.7734 I-0.03555 J0.01626
G2 X1.65101 Y-4.65189 Z-0.6740 I-0.01069 J-0.01888
G2 X1.26829 Y-4.89061 Z-0.6740 I-0.30169 J0.05753
G2 X2.87803 Y-4.96562 Z-0.6215 I0.80244 J-0.08970
G3 X4.29258 Y-5.06339 Z-0.5367 I0.67902 J-0.49795
G3 X4.16533 Y-4.86808 Z-0.4646 I-0.05269 J0.10478
G2 X4.42220 Y-4.95826 Z-0.3012 I0.18876 J0.12676
G3 X4.38016 Y-4.96619 Z0.0952 I-0.03646 J0.02827
G3 X4.35539 Y-4.92796 Z0.1288 I0.00333 J0.01079
G3 X4.51995 Y-4.89334 Z0.6938 I0.06933 J0.07884
G3 X5.38223 Y-2.69311 Z0.6938 I0.64284 J1.01715
G2 X5.44756 Y-2.79525 Z0.6938 I0.04606 J-0.02914
G2 X5.44756 Y-2.79525 I-0.09536 J-0.60920
G3 X4.84478 Y-2.32678 Z0.6938 I-0.41709 J0.08536
G2 X5.41219 Y-2.66330 Z0.6938 I0.00002 J-0.64658
G2 X5.42788 Y-2.66354 Z0.6938 I0.00798 J0.00859
G3 X5.55792 Y-2.08904 Z0.9605 I-0.53393 J0.42283
G2 X5.49189 Y-2.09843 Z0.9605 I-0.02731 J-0.00574
G3 X5.49189 Y-2.09843 I0.01240 J0.01731
G2 X4.59455 Y-1.97181 Z0.9605 I-0.51374 J-0.39785
G3 X4.58486 Y-1.92403 Z0.9605 I-0.00402 J0.02406
G2 X4.61796 Y-1.89029 Z0.9605 I0.02470 J0.00887
G3 X4.56726 Y-1.93758 Z0.8952 I-0.06039 J0.01393
G3 X4.71876 Y-2.00161 Z0.8952 I0.07718 J-0.02863
G2 X4.68861 Y-2.03375 Z0.8952 I-0.00039 J-0.02985
M2
"""


def through(name, text, most_s):
    t.write(name, text)
    status, out, err = t.run("run", name, "--json", "s.json", "--quiet", "--until", str(most_s))
    summary = t.load_json("s.json")
    broken = {check["name"]: check["value"] for check in summary["checks"] if not check["held"]}
    t.check(status == 0 and not broken, name + ": every check is held, no bend of a few tolerances is left out", broken, out, err)
    t.check(summary["outcome"] == "completed", name + ": the program comes to its end", summary["outcome"], summary["program_time_s"])


def time_of(program, acceleration, jerk, *options):
    limits = [f"axis.{axis}.max_{limit}" for axis in "XYZ" for limit in (f"acceleration_mm_s2={acceleration}", f"jerk_mm_s3={jerk}")]
    status, out, err = t.run("run", program, "--json", "s.json", "--quiet", "--until", "200", *options, *(word for limit in limits for word in ("--set", limit)))
    t.check(status == 0, "every check is held", program, limits, options, out, err)
    return t.load_json("s.json")["program_time_s"]


def stiff_and_soft():
    """Accelerations and jerks 16- and 100-fold apart: a stiff machine took up to four times as long as on the exact path."""
    with open(os.path.join(t.OWN_PROGRAMS, "winding.ngc"), encoding="utf-8") as file:
        text = file.read()
    for acceleration, jerk in ((250, 1e4), (250, 1e6), (1000, 1e6), (4000, 1e6)):
        exact = time_of(t.write("exact.ngc", text), acceleration, jerk)
        for tolerance in (0.01, 0.1):
            smooth = time_of(t.write("smooth.ngc", text.replace("G61", f"G64 P{tolerance}")), acceleration, jerk)
            t.check(smooth < exact, "smoothing gains time", acceleration, jerk, tolerance, smooth, exact)


stiff_and_soft()
through("loops.ngc", LOOPS, 60)
through("bends.ngc", BENDS, 60)
t.finish()
