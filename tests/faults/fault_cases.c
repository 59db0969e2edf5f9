/*
 * The faults, and what is to come of each. The program moves all three axes from the moment the
 * drives are enabled.
 */
#include "fault_run.h"

/* Rows: the program goes on; it is stopped; nothing has moved yet. */
#define GOES_ON(name, script, off_max_mm)                                                          \
    {                                                                                              \
        name, script, FAULT_PLAIN, TAKT_OK, "", 0, off_max_mm                                      \
    }
#define STOPS(name, script, alarm, text, stop_max_ms, off_max_mm)                                  \
    {                                                                                              \
        name, script, FAULT_PLAIN, TAKT_ERROR_##alarm, text, stop_max_ms, off_max_mm               \
    }
#define REFUSED(name, script, alarm, text)                                                         \
    {                                                                                              \
        name, script, FAULT_PLAIN, TAKT_ERROR_##alarm, text, 0, 0.0001                             \
    }

/* The same with an I/O node. */
#define IO_GOES_ON(name, script, off_max_mm)                                                       \
    {                                                                                              \
        name, script, FAULT_WITH_IO, TAKT_OK, "", 0, off_max_mm                                    \
    }
#define IO_STOPS(name, script, alarm, text, stop_max_ms, off_max_mm)                               \
    {                                                                                              \
        name, script, FAULT_WITH_IO, TAKT_ERROR_##alarm, text, stop_max_ms, off_max_mm             \
    }
#define IO_REFUSED(name, script, alarm, text)                                                      \
    {                                                                                              \
        name, script, FAULT_WITH_IO, TAKT_ERROR_##alarm, text, 0, 0.0001                           \
    }

/* The same with two drives of Y. */
#define GANTRY_STOPS(name, script, alarm, text, stop_max_ms, off_max_mm)                           \
    {                                                                                              \
        name, script, FAULT_GANTRY, TAKT_ERROR_##alarm, text, stop_max_ms, off_max_mm              \
    }

/* The same with drives that have no heartbeat. */
#define GUARDED_STOPS(name, script, alarm, text, stop_max_ms, off_max_mm)                          \
    {                                                                                              \
        name, script, FAULT_GUARDED, TAKT_ERROR_##alarm, text, stop_max_ms, off_max_mm             \
    }
#define GUARDED_GOES_ON(name, script, off_max_mm)                                                  \
    {                                                                                              \
        name, script, FAULT_GUARDED, TAKT_OK, "", 0, off_max_mm                                    \
    }

/* clang-format off */
const struct fault_case fault_cases[] = {
    /* frames lost */
    GOES_ON("1 frame of targets of X and Y is lost", "enabled+0.5s bus drop id=301", 0.02),
    STOPS("10 frames of targets of X and Y are lost", "enabled+0.5s bus drop id=301 frames=10",
          DRIVE_FOLLOWING, "axis X (node 1) lags ", 150, 1),
    STOPS("100 frames of targets of X and Y are lost", "enabled+0.5s bus drop id=301 frames=100",
          DRIVE_FOLLOWING, "axis X (node 1) lags ", 150, 1),
    GOES_ON("1 position of Y is lost", "enabled+0.5s bus drop id=182", 0.001),
    GOES_ON("10 positions of Y are lost", "enabled+0.5s bus drop id=182 frames=10", 0.001),
    STOPS("100 positions of Y are lost", "enabled+0.5s bus drop id=182 frames=100", DRIVE_SILENT,
          "the drive of axis Y (node 2) has sent no position for 21 ms", 200, 1),
    GOES_ON("1 SYNC is lost", "enabled+0.5s bus drop id=080", 0.02),
    STOPS("10 SYNC are lost", "enabled+0.5s bus drop id=080 frames=10", DRIVE_FAULT,
          "the drive of axis X (node 1) reports 8700: SYNC missing or at the wrong time", 150, 1),
    STOPS("100 SYNC are lost", "enabled+0.5s bus drop id=080 frames=100", DRIVE_FAULT,
          "the drive of axis X (node 1) reports 8700: SYNC missing or at the wrong time", 150, 1),

    /* frames late, spoilt, doubled */
    GOES_ON("a SYNC comes 0.3 ms late", "enabled+0.5s bus delay id=080 by=300us", 0.02),
    GOES_ON("every SYNC of 0.1 s comes 0.3 ms late", "enabled+0.5s bus delay id=080 by=300us for=0.1s", 0.03),
    GOES_ON("a SYNC comes 3 ms late", "enabled+0.5s bus delay id=080 by=3ms", 0.02),
    GOES_ON("1 target of X and Y is corrupted", "enabled+0.5s bus corrupt id=301", 0.001),
    GOES_ON("1 frame in 100 is corrupted for 1 s", "enabled+0.2s bus corrupt ratio=0.01 seed=7 for=1s", 0.001),
    STOPS("every frame of the drive of Y is corrupted", "enabled+0.5s bus corrupt node=2 frames=all",
          DRIVE_SILENT, "the drive of axis Y (node 2) has sent no position for 21 ms", 200, 3),
    GOES_ON("every target of X and Y is doubled for 20 ms", "enabled+0.5s bus duplicate id=301 for=20ms", 0.001),
    GOES_ON("every position of Y is doubled for 20 ms", "enabled+0.5s bus duplicate id=182 for=20ms", 0.001),
    STOPS("every frame is doubled for 0.1 s: more than the bus can carry", "enabled+0.5s bus duplicate for=0.1s",
          DRIVE_FOLLOWING, "axis X (node 1) lags ", 150, 1),

    /* nodes off the bus */
    GOES_ON("the drive of Y becomes error passive", "enabled+0.5s bus error_passive node=2", 0.001),
    STOPS("the drive of Y is bus-off", "enabled+0.5s bus bus_off node=2", DRIVE_SILENT,
          "the drive of axis Y (node 2) has sent no position for 21 ms", 200, 3),
    STOPS("the controller is bus-off", "enabled+0.5s bus bus_off node=controller", DRIVE_UNREACHABLE,
          "the bus refuses frames for the drive of axis Y (node 2)", 150, 1),
    STOPS("the cable to the drive of X is cut", "enabled+0.5s bus cut node=1", DRIVE_SILENT,
          "the drive of axis X (node 1) has sent no position for 21 ms", 150, 2),
    STOPS("the cable to the controller is cut", "enabled+0.5s bus cut node=controller", DRIVE_UNREACHABLE,
          "the bus refuses frames for the drive of axis ", 150, 1),
    STOPS("the cable to the drive of X has a loose contact for 5 ms", "enabled+0.5s bus cut node=1 for=5ms",
          DRIVE_FAULT, "the drive of axis X (node 1) reports 8700: SYNC missing or at the wrong time", 150, 1),

    /* what drives say */
    STOPS("the drive of X gets too hot", "enabled+0.5s drive 1 emcy code=4310", DRIVE_FAULT,
          "the drive of axis X (node 1) reports 4310: drive too hot", 150, 1),
    STOPS("the DC bus of the drive of Z has over-voltage", "enabled+0.5s drive 3 emcy code=3210", DRIVE_FAULT,
          "the drive of axis Z (node 3) reports 3210: DC bus over-voltage", 150, 1),
    STOPS("the drive of Y sends an emergency and goes on", "enabled+0.5s drive 2 warn code=FF01", DRIVE_FAULT,
          "the drive of axis Y (node 2) reports FF01: additional functions", 150, 0.01),
    STOPS("the heartbeat of the drive of Y stops", "enabled+0.2s drive 2 mute what=heartbeat", DRIVE_HEARTBEAT,
          "the drive of axis Y (node 2) has sent no heartbeat for 301 ms", 500, 0.01),
    STOPS("the drive of Y sends no more positions", "enabled+0.5s drive 2 mute what=tpdo", DRIVE_SILENT,
          "the drive of axis Y (node 2) has sent no position for 21 ms", 200, 1),
    STOPS("the drive of Y hangs", "enabled+0.5s drive 2 hang", DRIVE_SILENT,
          "the drive of axis Y (node 2) has sent no position for 21 ms", 200, 3),
    STOPS("the drive of Y starts anew, without torque", "enabled+0.5s drive 2 reboot", DRIVE_REBOOTED,
          "the drive of axis Y (node 2) has restarted", 2500, 20),
    STOPS("the drive of Y shows 'switch on disabled'", "enabled+0.5s drive 2 report object=6041 value=250",
          DRIVE_STATE, "the drive of axis Y (node 2) has left operation: its state is 'switch on disabled'", 150, 1),
    GOES_ON("the statusword of Y is stuck", "enabled+0.2s drive 2 freeze object=6041", 0.001),
    STOPS("the statusword of Y is stuck, and the drive fails",
          "enabled+0.5s drive 2 freeze object=6041\nenabled+0.5s drive 2 emcy code=7305\n", DRIVE_FAULT,
          "the drive of axis Y (node 2) reports 7305: encoder", 150, 1.2),

    /* drives without a heartbeat, which are guarded */
    GUARDED_GOES_ON("an answer of the guarded drive of Y is lost", "enabled+0.5s bus drop id=702 node=2", 0.001),
    GUARDED_STOPS("the guarded drive of Y does not answer any more", "enabled+0.2s drive 2 mute what=heartbeat",
                  DRIVE_HEARTBEAT, "the drive of axis Y (node 2) has sent no heartbeat for 301 ms", 500, 0.01),
    GUARDED_STOPS("the cable to the guarded drive of X is cut", "enabled+0.5s bus cut node=1", DRIVE_SILENT,
                  "the drive of axis X (node 1) has sent no position for 21 ms", 150, 2),
    GUARDED_STOPS("the guarding frames to Y are lost: it stops by itself", "enabled+0.2s bus drop id=702 node=controller frames=all",
                  DRIVE_FAULT, "the drive of axis Y (node 2) reports 8130: ", 500, 1),

    /* what axes do */
    STOPS("the position of X is stuck", "enabled+0.5s drive 1 freeze object=6064", DRIVE_FOLLOWING,
          "axis X (node 1) lags ", 200, 1),
    STOPS("the axis X jams", "enabled+0.5s drive 1 jam", DRIVE_FOLLOWING, "axis X (node 1) lags ", 150, 2),
    STOPS("the motor of X has 2 % of its torque", "enabled+0.02s drive 1 weak ratio=0.02", DRIVE_FOLLOWING,
          "axis X (node 1) lags ", 400, 2),
    GOES_ON("the encoder of X jumps by 0.5 mm", "enabled+0.5s drive 1 encoder_jump by_mm=0.5", 0.4),
    STOPS("the encoder of X jumps by 5 mm", "enabled+0.5s drive 1 encoder_jump by_mm=5", DRIVE_FAULT,
          "the drive of axis X (node 1) reports 8611: following error", 150, 1),

    /* inputs and outputs */
    IO_STOPS("the stop input opens", "enabled+0.5s io 4 report object=6000:01 value=02", IO_STOP,
             "the stop input, bit 0 of I/O node 4, is open", 150, 1),
    IO_STOPS("the limit input opens", "enabled+0.5s io 4 report object=6000:01 value=01", IO_LIMIT,
             "the limit input, bit 1 of I/O node 4, has opened", 150, 1),
    IO_GOES_ON("10 reports of the inputs are lost", "enabled+0.5s bus drop id=184 frames=10", 0.001),
    IO_STOPS("the I/O node sends no more inputs", "enabled+0.5s io 4 mute what=tpdo", IO_SILENT,
             "I/O node 4 has sent no inputs for 21 ms", 250, 0.01),
    IO_STOPS("the I/O node hangs", "enabled+0.5s io 4 hang", IO_SILENT, "I/O node 4 has sent no inputs for 21 ms", 250, 0.01),
    IO_STOPS("the cable to the I/O node is cut", "enabled+0.5s bus cut node=4", IO_SILENT,
             "I/O node 4 has sent no inputs for 21 ms", 250, 0.01),
    IO_STOPS("the heartbeat of the I/O node stops", "enabled+0.2s io 4 mute what=heartbeat", IO_HEARTBEAT,
             "I/O node 4 has sent no heartbeat for 301 ms", 500, 0.01),
    IO_STOPS("the I/O node starts anew", "enabled+0.5s io 4 reboot", IO_LEFT,
             "I/O node 4 is not operational any more, but restarted", 250, 0.01),
    IO_STOPS("the I/O node reports a short circuit", "enabled+0.5s io 4 warn code=2320", IO_FAULT,
             "I/O node 4 reports 2320: ", 250, 0.01),

    /* two drives of Y */
    GANTRY_STOPS("the second drive of Y jams", "enabled+0.5s drive 4 jam", DRIVE_SKEW, "axis Y2 (node 4) is ", 150, 1),
    GANTRY_STOPS("the second motor of Y has 2 % of its torque", "enabled+0.02s drive 4 weak ratio=0.02", DRIVE_SKEW,
                 "axis Y2 (node 4) is ", 400, 2),
    GANTRY_STOPS("the position of the second drive of Y is stuck", "enabled+0.5s drive 4 freeze object=6064", DRIVE_SKEW,
                 "axis Y2 (node 4) is ", 200, 1),
    GANTRY_STOPS("the second drive of Y hangs", "enabled+0.5s drive 4 hang", DRIVE_SILENT,
                 "the drive of axis Y2 (node 4) has sent no position for 21 ms", 200, 3),
    GANTRY_STOPS("the second drive of Y gets too hot", "enabled+0.5s drive 4 emcy code=4310", DRIVE_FAULT,
                 "the drive of axis Y2 (node 4) reports 4310: drive too hot", 150, 1),

    /* at start */
    IO_REFUSED("the stop input is open at start", "power io 4 report object=6000:01 value=02", IO_STOP,
               "the stop input, bit 0 of I/O node 4, is open"),
    IO_GOES_ON("the limit input is open at start: it can be driven off", "power io 4 report object=6000:01 value=01", 0.001),
    IO_GOES_ON("the I/O node sends its inputs only when they change", "power io 4 sdo_abort object=1800:02 code=06010002", 0.001),
    IO_GOES_ON("NMT start of the I/O node is lost", "power bus drop id=000 skip=7 frames=1", 0.001),
    IO_REFUSED("the I/O node is absent", "power bus cut node=4", IO_ABSENT, "I/O node 4 has not booted within 6 s"),
    IO_REFUSED("the I/O node is none", "power io 4 report object=1000 value=20192", IO_TYPE,
               "I/O node 4 is no CiA 401 node: the device type, object 1000, is 00020192"),
    IO_REFUSED("the I/O node answers no request", "power io 4 mute what=sdo", IO_UNANSWERED,
               "I/O node 4, object 1000:00, does not answer within 2000 ms"),
    IO_REFUSED("the I/O node has its inputs elsewhere", "power io 4 report object=1A00:01 value=60010108", IO_UNMAPPED,
               "I/O node 4, object 1A00:01, is 60010108: "),
    REFUSED("the drive of Y is absent", "power bus cut node=2", DRIVE_ABSENT,
            "the drive of axis Y (node 2) has not booted within 6 s"),
    REFUSED("the drive of Z is another one", "power drive 3 report object=1018:02 value=403", DRIVE_IDENTITY,
            "axis Z (node 3) has another drive than the machine file says: its product code, object 1018:02, is 0403"),
    REFUSED("the node of Z is no drive", "power drive 3 report object=1000 value=30191\npower drive 3 report object=6502 value=0\n", DRIVE_TYPE,
            "axis Z (node 3) has no CiA 402 drive: the device type, object 1000, is 00030191"),
    GOES_ON("the drive of X refuses a mapping", "power drive 1 sdo_abort object=1A00:01 code=06040041", 0.001),
    REFUSED("the drive of X answers no request", "power drive 1 mute what=sdo", DRIVE_UNANSWERED,
            "the drive of axis X (node 1), object 1000:00, does not answer within 2000 ms"),
    GOES_ON("an answer of the drive of X to a request is lost", "power bus drop id=581 skip=10", 0.001),
    GOES_ON("NMT start of the drive of Z is lost", "power bus drop id=000 skip=6 frames=1", 0.001),
    REFUSED("the statusword of Z is stuck at start", "power drive 3 freeze object=6041", DRIVE_NOT_ENABLED,
            "the drive of axis Z (node 3) cannot be enabled: it stays in 'switch on disabled'"),
    REFUSED("the drive of Z stays in fault", "power drive 3 report object=6041 value=0218", DRIVE_FAULT,
            "the drive of axis Z (node 3) reports 0000: a fault without a code"),
    REFUSED("the drive of Y does not take its mode", "power drive 2 report object=6061 value=1", DRIVE_MODE,
            "the drive of axis Y (node 2) does not take the mode 8"),
    {"the axis X jams while it is homed", "power drive 1 jam", FAULT_HOMED, TAKT_ERROR_DRIVE_FAULT,
     "the drive of axis X (node 1) reports 8611: following error", 500, 0.0001},
};
/* clang-format on */

const unsigned fault_cases_count = sizeof fault_cases / sizeof fault_cases[0];
