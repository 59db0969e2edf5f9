/*
 * Objects of the communication profile, CiA 301, 7.5: indices of the dictionary that both ends of
 * the bus know. Those of the drive profile are in cia402.h.
 */
#ifndef TAKT_CANOPEN_OBJECTS_H
#define TAKT_CANOPEN_OBJECTS_H

#define OBJECT_DEVICE_TYPE        0x1000
#define OBJECT_ERROR_REGISTER     0x1001
#define OBJECT_SYNC_COB_ID        0x1005
#define OBJECT_SYNC_PERIOD        0x1006 /* us */
#define OBJECT_GUARD_TIME         0x100C /* ms */
#define OBJECT_LIFE_TIME_FACTOR   0x100D /* guard times without a guarding frame */
#define OBJECT_CONSUMER_HEARTBEAT 0x1016 /* each sub-index: node << 16 | ms */
#define OBJECT_PRODUCER_HEARTBEAT 0x1017 /* ms */
#define OBJECT_SYNC_OVERFLOW      0x1019 /* of the SYNC counter; 0: SYNC has none */
#define OBJECT_IDENTITY           0x1018 /* 1 vendor, 2 product code, 3 revision, 4 serial number */

/*
 * PDO n (from 0) has its parameters at the communication index plus n, its mapping at the mapping
 * index plus n.
 */
#define OBJECT_RPDO         0x1400
#define OBJECT_RPDO_MAPPING 0x1600
#define OBJECT_TPDO         0x1800
#define OBJECT_TPDO_MAPPING 0x1A00

/* Sub-indices of a PDO's communication parameters. */
#define OBJECT_PDO_COB_ID         1
#define OBJECT_PDO_TYPE           2
#define OBJECT_PDO_INHIBIT        3 /* 100 us */
#define OBJECT_PDO_INHIBIT_PER_MS 10u
#define OBJECT_PDO_EVENT_TIMER    5 /* ms */

/* Bits of a PDO's COB-ID. */
#define OBJECT_PDO_NOT_VALID 0x80000000u
#define OBJECT_PDO_NO_RTR    0x40000000u

/*
 * Device type: the lower half names the device profile, the upper half what the device has of it.
 */
#define OBJECT_DEVICE_PROFILE_MASK 0x0000FFFFu
#define OBJECT_DEVICE_PROFILE_401  0x00000191u
#define OBJECT_DEVICE_PROFILE_402  0x00000192u

/* Objects of I/O nodes (profile CiA 401): eight inputs or outputs a sub-index, from 1 on. */
#define OBJECT_IO_INPUTS           0x6000
#define OBJECT_IO_OUTPUTS          0x6200
#define OBJECT_IO_ANALOGUE_OUTPUTS 0x6411 /* 16 bits each */

#endif
