"""Five real part programs on the exact path: limits, path and landings from the trace, the same digest twice."""

import takt_test as t
from judged_run import judged_run

for program in t.real_programs("3d_chips.ngc", "arcspiral.ngc", "spiral_lines.ngc", "tort.ngc", "pasta.ngc"):
    judged_run(program, "--exact-path")
t.finish()
