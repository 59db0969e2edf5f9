"""A record of a real drive, as `takt tune --record` reads it."""

import math

CYCLE_S = 1e-3


def recorded(cycles=800, fine=50):
    """Of an inertia that its own steps move: 0.5 Nm to and fro, 2.3 ms late, dry friction 0.05 Nm, read to 0.1 um."""
    x = v = 0.0
    for k in range(cycles):
        yield 0.5 if (k // 12 + 1) // 2 % 2 == 0 else -0.5, round(x, 4)
        for i in range(fine):
            at = math.floor(k + (i + 0.5) / fine - 2.3)
            torque = 0 if at < 0 else 0.5 if (at // 12 + 1) // 2 % 2 == 0 else -0.5
            turning = math.copysign(0.05, v) if v else 0
            v += 10 / (2 * math.pi) * (torque - turning) / 0.0018 * CYCLE_S / fine
            x += v * CYCLE_S / fine
