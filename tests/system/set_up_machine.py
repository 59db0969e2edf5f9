"""The machine with a rotary table on which parts are set up, without and with a reserve of the axes for that."""

PIVOT = [40.0, -25.0, -60.0]
MACHINE = """[axis X]
travel_min_mm = -150
travel_max_mm = 150
[axis Y]
travel_min_mm = -150
travel_max_mm = 150
[axis Z]
travel_min_mm = -150
travel_max_mm = 150
[axis C]
max_velocity_deg_s = 90
max_acceleration_deg_s2 = 360
max_jerk_deg_s3 = 3600
[machine]
chain = w C X Y b Z t
[correction]
turn_axis = C
setup_pivot_mm = 40 -25 -60
"""
RESERVED = MACHINE + "reserve_ratio = 0.2\n"
