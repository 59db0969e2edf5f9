"""takt run of smoothed paths (G64 P) that are hard to get through."""

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


def through(name, text, most_s):
    t.write(name, text)
    status, out, err = t.run("run", name, "--json", "s.json", "--quiet", "--until", str(most_s))
    t.check(status == 0, name + ": every check is held", out, err)
    summary = t.load_json("s.json")
    t.check(summary["outcome"] == "completed", name + ": the program comes to its end", summary["outcome"], summary["program_time_s"])


through("loops.ngc", LOOPS, 60)
t.finish()
