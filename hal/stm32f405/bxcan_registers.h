/*
 * Registers of bxCAN, offsets from its base.
 */
#ifndef TAKT_STM32F405_BXCAN_REGISTERS_H
#define TAKT_STM32F405_BXCAN_REGISTERS_H

#define BXCAN_CAN1 0x40006400U

#define BXCAN_MCR  0x00U
#define BXCAN_MSR  0x04U
#define BXCAN_TSR  0x08U
#define BXCAN_RF0R 0x0CU
#define BXCAN_IER  0x14U
#define BXCAN_ESR  0x18U
#define BXCAN_BTR  0x1CU

#define BXCAN_MCR_INRQ  (1U << 0)
#define BXCAN_MCR_SLEEP (1U << 1)
#define BXCAN_MCR_RESET (1U << 15)

#define BXCAN_MSR_INAK (1U << 0)
#define BXCAN_MSR_SLAK (1U << 1)
#define BXCAN_MSR_ERRI (1U << 2)

/* For mailbox i = 0, 1, 2. */
#define BXCAN_TSR_RQCP(i)  (1U << (8U * (i)))
#define BXCAN_TSR_TXOK(i)  (2U << (8U * (i)))
#define BXCAN_TSR_ABRQ(i)  (0x80U << (8U * (i)))
#define BXCAN_TSR_EMPTY(i) (1U << (26U + (i)))

#define BXCAN_RF_PENDING_MASK 3U
#define BXCAN_RF_OVERRUN      (1U << 4)
#define BXCAN_RF_RELEASE      (1U << 5)

#define BXCAN_IER_TRANSMIT (1U << 0)
#define BXCAN_IER_RECEIVE  (1U << 1)
#define BXCAN_IER_OVERRUN  (1U << 3)

#define BXCAN_ESR_WARNING     (1U << 0)
#define BXCAN_ESR_PASSIVE     (1U << 1)
#define BXCAN_ESR_BUS_OFF     (1U << 2)
#define BXCAN_ESR_LAST(esr)   (((esr) >> 4) & 7U)
#define BXCAN_ESR_SENT(esr)   (((esr) >> 16) & 0xFFU)
#define BXCAN_ESR_HEARD(esr)  (((esr) >> 24) & 0xFFU)
#define BXCAN_ESR_LAST_UNUSED 7U

#define BXCAN_BTR_BRP(divider) ((divider)-1U)
#define BXCAN_BTR_TS1(quanta)  (((quanta)-1U) << 16)
#define BXCAN_BTR_TS2(quanta)  (((quanta)-1U) << 20)
#define BXCAN_BTR_SJW(quanta)  (((quanta)-1U) << 24)

/* Mailboxes: three to send, then the head of a receive FIFO in the same form. */
#define BXCAN_TI(i)     (0x180U + 0x10U * (i))
#define BXCAN_TDT(i)    (0x184U + 0x10U * (i))
#define BXCAN_TDL(i)    (0x188U + 0x10U * (i))
#define BXCAN_TDH(i)    (0x18CU + 0x10U * (i))
#define BXCAN_RI        0x1B0U
#define BXCAN_RDT       0x1B4U
#define BXCAN_RDL       0x1B8U
#define BXCAN_RDH       0x1BCU
#define BXCAN_TI_TXRQ   (1U << 0)
#define BXCAN_I_REMOTE  (1U << 1)
#define BXCAN_I_LONG    (1U << 2)
#define BXCAN_I_ID(id)  ((uint32_t)(id) << 21)
#define BXCAN_ID_OF(i)  ((i) >> 21)
#define BXCAN_LENGTH(t) ((t)&15U)

#define BXCAN_FMR      0x200U
#define BXCAN_FM1R     0x204U
#define BXCAN_FS1R     0x20CU
#define BXCAN_FFA1R    0x214U
#define BXCAN_FA1R     0x21CU
#define BXCAN_FR1(i)   (0x240U + 8U * (i))
#define BXCAN_FR2(i)   (0x244U + 8U * (i))
#define BXCAN_FMR_INIT (1U << 0)
#define BXCAN_BANKS    14U /* of CAN1, as long as CAN2 keeps its own */

/* A filter of 16 bits: the identifier, then RTR and IDE; the mask of the same form above it. */
#define BXCAN_FILTER(id, mask) ((uint32_t)(id) << 5 | ((uint32_t)(mask) << 5 | 0x18U) << 16)

#endif
