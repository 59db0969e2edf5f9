/*
 * Registers of FDCAN, offsets from its base, and its elements in the message memory (RM0433, 56.4
 * and 56.5).
 */
#ifndef TAKT_STM32H743_FDCAN_REGISTERS_H
#define TAKT_STM32H743_FDCAN_REGISTERS_H

#define FDCAN_1      0x4000A000U
#define FDCAN_CCFG   0x4000A804U /* of the unit that could derive the clock from the bus */
#define FDCAN_MEMORY 0x4000AC00U /* 2560 words, of all controllers */

#define FDCAN_DBTP   0x0CU
#define FDCAN_CCCR   0x18U
#define FDCAN_NBTP   0x1CU
#define FDCAN_ECR    0x40U
#define FDCAN_PSR    0x44U
#define FDCAN_TDCR   0x48U
#define FDCAN_IR     0x50U
#define FDCAN_IE     0x54U
#define FDCAN_ILS    0x58U
#define FDCAN_ILE    0x5CU
#define FDCAN_GFC    0x80U
#define FDCAN_SIDFC  0x84U
#define FDCAN_XIDFC  0x88U
#define FDCAN_RXF0C  0xA0U
#define FDCAN_RXF0S  0xA4U
#define FDCAN_RXF0A  0xA8U
#define FDCAN_RXESC  0xBCU
#define FDCAN_TXBC   0xC0U
#define FDCAN_TXESC  0xC8U
#define FDCAN_TXBRP  0xCCU
#define FDCAN_TXBAR  0xD0U
#define FDCAN_TXBCR  0xD4U
#define FDCAN_TXBTO  0xD8U
#define FDCAN_TXBCF  0xDCU
#define FDCAN_TXBTIE 0xE0U
#define FDCAN_TXBCIE 0xE4U

#define FDCAN_CCFG_BYPASS (1U << 6)

#define FDCAN_CCCR_INIT (1U << 0)
#define FDCAN_CCCR_CCE  (1U << 1)
#define FDCAN_CCCR_FDOE (1U << 8)
#define FDCAN_CCCR_BRSE (1U << 9)

#define FDCAN_NBTP_BRP(divider) (((divider)-1U) << 16)
#define FDCAN_NBTP_TS1(quanta)  (((quanta)-1U) << 8)
#define FDCAN_NBTP_TS2(quanta)  ((quanta)-1U)
#define FDCAN_NBTP_SJW(quanta)  (((quanta)-1U) << 25)
#define FDCAN_DBTP_BRP(divider) (((divider)-1U) << 16)
#define FDCAN_DBTP_TS1(quanta)  (((quanta)-1U) << 8)
#define FDCAN_DBTP_TS2(quanta)  (((quanta)-1U) << 4)
#define FDCAN_DBTP_SJW(quanta)  ((quanta)-1U)
#define FDCAN_DBTP_TDC          (1U << 23)
#define FDCAN_TDCR_OFFSET(n)    ((n) << 8)

#define FDCAN_ECR_SENT(ecr)  ((ecr)&0xFFU)
#define FDCAN_ECR_HEARD(ecr) (((ecr) >> 8) & 0x7FU)

/* Errors outside of fast data, and in it: 7 is "none since the last read". */
#define FDCAN_PSR_LAST(psr)      ((psr)&7U)
#define FDCAN_PSR_LAST_DATA(psr) (((psr) >> 8) & 7U)
#define FDCAN_PSR_LAST_UNCHANGED 7U
#define FDCAN_PSR_ACTIVITY(psr)  (((psr) >> 3) & 3U) /* 0: not in step with the bus yet */
#define FDCAN_PSR_BUS_OFF        (1U << 7)

#define FDCAN_IR_RECEIVED  (1U << 0)
#define FDCAN_IR_LOST      (1U << 3)
#define FDCAN_IR_SENT      (1U << 9)
#define FDCAN_IR_CANCELLED (1U << 10)
#define FDCAN_ILE_BOTH     3U

/* No identifier of 29 bits, no remote frame, and what no filter names is refused. */
#define FDCAN_GFC_NAMED_ONLY 0x2FU
#define FDCAN_GFC_ANY        0x0FU /* as above, but what no filter names is taken */

#define FDCAN_SIDFC_LIST(word, count) ((word) << 2 | (count) << 16)
#define FDCAN_RXF0C_LIST(word, count) ((word) << 2 | (count) << 16)
#define FDCAN_TXBC_LIST(word, count)  ((word) << 2 | (count) << 16)
#define FDCAN_ESC_64_BYTES            7U

#define FDCAN_RXF0S_LEVEL(s) ((s)&0x7FU)
#define FDCAN_RXF0S_FIRST(s) (((s) >> 8) & 0x3FU)
#define FDCAN_RXF0S_LOST     (1U << 25)

/* A filter by identifier and mask, for the first FIFO. */
#define FDCAN_FILTER(id, mask) (2U << 30 | 1U << 27 | (uint32_t)(id) << 16 | (mask))

/* An element: two words and the data. */
#define FDCAN_ELEMENT_WORDS 18U
#define FDCAN_E0_LONG       (1U << 30)
#define FDCAN_E0_REMOTE     (1U << 29)
#define FDCAN_E0_ID(id)     ((uint32_t)(id) << 18)
#define FDCAN_E0_ID_OF(e0)  (((e0) >> 18) & 0x7FFU)
#define FDCAN_E1_FD         (1U << 21)
#define FDCAN_E1_FAST       (1U << 20)
#define FDCAN_E1_DLC(code)  ((uint32_t)(code) << 16)
#define FDCAN_E1_DLC_OF(e1) (((e1) >> 16) & 15U)

#endif
