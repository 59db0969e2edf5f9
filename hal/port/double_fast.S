/*
 * Sum, difference, product and order of two doubles for a core whose unit is for single precision alone: the cases that
 * a control cycle meets, in half the instructions of libgcc. All others are left to soft_double.c (sums, order) and to
 * libgcc (products), with the arguments as they came.
 *
 * A double is in r0 (low) and r1, the other one in r2 and r3; the result is in r0 and r1. A common number has an exponent
 * of 512 to 1535, that is 2^-511 to 2^513: of its two upper bits one is set. No sum of two of them overflows or becomes
 * subnormal, and no product with a number that is nearer to 1 still. So only the digits that are left over must be looked
 * at:
 *
 *     lr, as a fraction of the last bit: above a half rounds up, a half rounds to even
 */
    .syntax unified
    .thumb
    .cpu cortex-m4
    .text

    .macro function name
    .section .text.\name, "ax", %progbits
    .balign 4
    .global \name
    .thumb_func
    .type \name, %function
\name:
    .endm

    /* Branches if one of both is not common, or, with narrow, the second is beyond 2^-255 or 2^257. r4 and r5 are lost. */
    .macro unless_common to, narrow=0
    eor     r4, r1, r1, lsl #1
    eor     r5, r3, r3, lsl #1
    .if \narrow
    bic     r5, r5, r5, lsl #1
    .endif
    and     r4, r4, r5
    tst     r4, #0x40000000
    beq     \to
    .endm

/* ---- a b ---- */

    function __wrap___aeabi_dmul
    push    {r4, r5, lr}
    unless_common rare_product, 1
    lsr     r4, r1, #20                 /* signs and exponents at once: what signs carry is shifted out at the end */
    add     r4, r4, r3, lsr #20
    sub     r4, r4, #1024
    lsl     r1, r1, #11                 /* a 2^63, with its hidden bit */
    orr     r1, r1, r0, lsr #21
    lsl     r0, r0, #11
    orr     r1, r1, #0x80000000
    mov     r5, #1                      /* b 2^52 */
    bfi     r3, r5, #20, #12
    umull   r12, lr, r0, r2             /* their product: r5 r0 lr r12 */
    mov     r5, #0
    umaal   lr, r5, r0, r3
    mov     r0, #0
    umaal   lr, r0, r1, r2
    umaal   r0, r5, r1, r3
    tst     r5, #0x100000
    bne     2f
    lsls    lr, lr, #1                  /* below 2: once more by 2 */
    adcs    r0, r0, r0
    adc     r5, r5, r5
    lsls    lr, lr, #1
    beq     half_product
1:  adcs    r0, r0, #0
    adc     r1, r5, r4, lsl #20
    pop     {r4, r5, pc}
2:  add     r4, r4, #1
    lsls    lr, lr, #1
    beq     half_product
    adcs    r0, r0, #0
    adc     r1, r5, r4, lsl #20
    pop     {r4, r5, pc}

half_product:                           /* carry: a half and r12, else only r12 is left over */
    bcc     1b
    cmp     r12, #0
    bne     3f                          /* more than a half: cmp has left the carry set */
    lsrs    r12, r0, #1                 /* carry: the last bit is odd */
3:  b       1b

rare_product:
    pop     {r4, r5, lr}
    orrs    r12, r0, r1, lsl #1
    beq     4f
    orrs    r12, r2, r3, lsl #1
    bne     __real___aeabi_dmul
4:  eor     r12, r1, r3                 /* 0: nothing but the sign is left, if the other one is finite */
    bic     r1, r1, #0x80000000
    bic     r3, r3, #0x80000000
    orr     r1, r1, r3
    cmp     r1, #0x7F000000
    bhs     5f
    mov     r0, #0
    and     r1, r12, #0x80000000
    bx      lr
5:  orr     r0, r0, r2                  /* one is 0, so r0 and r1 are the other one: times 0 with the right sign */
    mov     r2, #0
    and     r3, r12, #0x80000000
    b       __real___aeabi_dmul

/* ---- a - b, b - a, a + b ---- */

    function __wrap___aeabi_drsub
    eor     r1, r1, #0x80000000
    b       __wrap___aeabi_dadd

    function __wrap___aeabi_dsub
    eor     r3, r3, #0x80000000
    b       __wrap___aeabi_dadd

    function __wrap___aeabi_dadd
    push    {r4, r5, lr}
    unless_common rare_sum
    ubfx    r4, r1, #20, #11
    ubfx    r5, r3, #20, #11
    subs    r5, r4, r5
    bmi     exchange
larger_first:
    eors    r12, r1, r3                 /* minus: the signs differ */
    lsr     r4, r1, #20
    mov     lr, #1
    bfi     r1, lr, #20, #12
    bfi     r3, lr, #20, #12
    bmi     subtract
    cmp     r5, #32
    bhs     add_far
    rsb     r12, r5, #32                /* b to the exponent of a; what falls out is in lr */
    lsl     lr, r2, r12
    lsr     r2, r2, r5
    lsl     r12, r3, r12
    orr     r2, r2, r12
    lsr     r3, r3, r5
add_fractions:
    sub     r4, r4, #1
    adds    r0, r0, r2
    adc     r1, r1, r3
    tst     r1, #0x200000
    bne     carry_out
round_sum:
    lsls    lr, lr, #1
    beq     half_sum
rounded_sum:
    adcs    r0, r0, #0
    adc     r1, r1, r4, lsl #20
    pop     {r4, r5, pc}

half_sum:
    bcc     rounded_sum
    lsrs    r12, r0, #1                 /* carry: the last bit is odd */
    b       rounded_sum

carry_out:                              /* a bit more on top: what it pushes out is the highest of what is left over */
    add     r4, r4, #1
    cmp     lr, #1                      /* carry: something is left over */
    it      cs
    orrcs   lr, lr, #2
    lsr     lr, lr, #1
    orr     lr, lr, r0, lsl #31
    lsr     r0, r0, #1
    orr     r0, r0, r1, lsl #31
    lsr     r1, r1, #1
    b       round_sum

exchange:
    rsb     r5, r5, #0
    mov     r12, r0
    mov     r0, r2
    mov     r2, r12
    mov     r12, r1
    mov     r1, r3
    mov     r3, r12
    b       larger_first

subtract:
    cmp     r5, #32
    bhs     subtract_far
    rsb     r12, r5, #32
    lsl     lr, r2, r12
    lsr     r2, r2, r5
    lsl     r12, r3, r12
    orr     r2, r2, r12
    lsr     r3, r3, r5
subtract_fractions:
    rsbs    lr, lr, #0
    sbcs    r0, r0, r2
    sbcs    r1, r1, r3
    bmi     negate
positive:
    sub     r4, r4, #1
    tst     r1, #0x100000
    bne     round_sum
    sub     r4, r4, #1                  /* one bit is missing on top, as mostly */
    lsls    lr, lr, #1
    adcs    r0, r0, r0
    adc     r1, r1, r1
    tst     r1, #0x100000
    bne     round_sum
    cmp     r1, #0                      /* several: then nothing is left over, for the exponents differed by 1 at most */
    beq     low_word
    clz     r5, r1
    sub     r5, r5, #11
    sub     r4, r4, r5
    rsb     r12, r5, #32
    lsl     r1, r1, r5
    lsr     r12, r0, r12
    orr     r1, r1, r12
    lsl     r0, r0, r5
    add     r1, r1, r4, lsl #20
    pop     {r4, r5, pc}

low_word:
    cmp     r0, #0
    beq     equal
    clz     r5, r0
    lsl     r0, r0, r5
    add     r5, r5, #21
    sub     r4, r4, r5
    lsr     r1, r0, #11
    lsl     r0, r0, #21
    add     r1, r1, r4, lsl #20
    pop     {r4, r5, pc}

equal:                                  /* a - a is +0 */
    mov     r1, #0
    pop     {r4, r5, pc}

negate:                                 /* the exponents were the same: nothing is left over */
    rsbs    r0, r0, #0
    sbc     r1, r1, r1, lsl #1
    eor     r4, r4, #0x800
    b       positive

add_far:
    bl      shift_far
    b       add_fractions

subtract_far:
    bl      shift_far
    b       subtract_fractions

shift_far:                              /* by 32 and more: from 55 on b is only something that is left over */
    push    {lr}
    sub     r5, r5, #32
    cmp     r5, #24
    it      hs
    movhs   r5, #24
    rsb     r12, r5, #32
    lsls    lr, r2, r12                 /* what is lost of the low word */
    lsr     r2, r2, r5
    it      ne
    orrne   r2, r2, #1
    lsl     lr, r3, r12
    orr     lr, lr, r2
    lsr     r2, r3, r5
    mov     r3, #0
    pop     {pc}

rare_sum:                               /* 0 is the common one of them */
    orrs    r12, r2, r3, lsl #1
    beq     6f
    orrs    r12, r0, r1, lsl #1
    beq     7f
    pop     {r4, r5, lr}
    b       soft_double_add
6:  orrs    r12, r0, r1, lsl #1
    it      eq
    andeq   r1, r1, r3                  /* -0 only of two of them */
    pop     {r4, r5, pc}
7:  mov     r0, r2
    mov     r1, r3
    pop     {r4, r5, pc}

/* ---- a < b, a <= b, a > b, a >= b: of positive numbers as of integers ---- */

    /* To slow where one is negative, or the upper half of the one that would be the larger may be that of none. */
    .macro order name, upper, slow
    function \name
    orrs    r12, r1, r3
    bmi     \slow
    cmn     \upper, #0x100000
    bmi     \slow
    .endm

    order   __wrap___aeabi_dcmplt, r3, soft_double_is_less
    subs    r0, r0, r2
    sbcs    r1, r1, r3
    sbc     r0, r0, r0
    rsb     r0, r0, #0
    bx      lr

    order   __wrap___aeabi_dcmpgt, r1, soft_double_is_more
    subs    r0, r2, r0
    sbcs    r1, r3, r1
    sbc     r0, r0, r0
    rsb     r0, r0, #0
    bx      lr

    order   __wrap___aeabi_dcmple, r3, soft_double_is_not_more
    subs    r0, r2, r0
    sbcs    r1, r3, r1
    mov     r0, #0
    adc     r0, r0, #0
    bx      lr

    order   __wrap___aeabi_dcmpge, r1, soft_double_is_not_less
    subs    r0, r0, r2
    sbcs    r1, r1, r3
    mov     r0, #0
    adc     r0, r0, #0
    bx      lr
