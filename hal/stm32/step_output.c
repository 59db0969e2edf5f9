#include "stm32/step_output.h"

#include "chip/board.h"
#include "chip/peripherals.h"
#include "stm32/chip.h"

#include <string.h>

#define TIM8 0x40010400U
#define CR1  (TIM8 + 0x00U)
#define DIER (TIM8 + 0x0CU)
#define EGR  (TIM8 + 0x14U)
#define PSC  (TIM8 + 0x28U)
#define ARR  (TIM8 + 0x2CU)

#define CR1_ON       1U
#define DIER_REQUEST (1U << 8) /* direct memory access at every update */
#define EGR_UPDATE   1U

#define NS_PER_S 1000000000U

/* Stream 1. */
#define LIFCR       (STEP_DMA + 0x08U)
#define STREAM      (STEP_DMA + 0x10U + 0x18U)
#define STREAM_CR   (STREAM + 0x00U)
#define STREAM_NDTR (STREAM + 0x04U)
#define STREAM_PAR  (STREAM + 0x08U)
#define STREAM_M0AR (STREAM + 0x0CU)
#define STREAM_M1AR (STREAM + 0x10U)

#define LIFCR_STREAM_1 (0x3DU << 6)

#define CR_ON          1U
#define CR_TO_PORT     (1U << 6)
#define CR_CIRCULAR    (1U << 8)
#define CR_STEP_MEMORY (1U << 10)
#define CR_16_BITS     (1U << 11 | 1U << 13)
#define CR_URGENT      (3U << 16)
#define CR_TWO_BUFFERS (1U << 18)
#define CR_SECOND      (1U << 19) /* the second buffer is being sent */

#define OFF_READS 10000U

static uint32_t address_of(const void *memory)
{
    return (uint32_t)(uintptr_t)memory;
}

static void set_pins(enum gpio_port port)
{
    for (unsigned axis = 0; axis < AXIS_COUNT; axis++) {
        takt_gpio_set_output((struct gpio_pin){port, (uint8_t)(BOARD_STEP_PIN + axis)});
        takt_gpio_set_output((struct gpio_pin){port, (uint8_t)(BOARD_DIRECTION_PIN + axis)});
    }
}

static bool set_stream(const struct step_output *s, enum gpio_port port)
{
    chip_change(RCC_AHB1ENR, 0, RCC_AHB1ENR_DMA2);
    peripherals_route_steps();
    takt_chip_write(STREAM_CR, 0);
    if (!chip_wait(STREAM_CR, CR_ON, 0, OFF_READS))
        return false;
    takt_chip_write(LIFCR, LIFCR_STREAM_1);
    takt_chip_write(STREAM_NDTR, s->slots.slots);
    takt_chip_write(STREAM_PAR, takt_gpio_get_output_register(port));
    takt_chip_write(STREAM_M0AR, address_of(s->levels[0]));
    takt_chip_write(STREAM_M1AR, address_of(s->levels[1]));
    takt_chip_write(STREAM_CR, CR_TO_PORT | CR_CIRCULAR | CR_STEP_MEMORY | CR_16_BITS | CR_URGENT |
                                   CR_TWO_BUFFERS | STEP_REQUEST);
    chip_change(STREAM_CR, 0, CR_ON);
    return true;
}

static void set_timer(uint32_t timer_hz)
{
    chip_change(RCC_APB2ENR, 0, RCC_APB2ENR_TIM8);
    takt_chip_write(CR1, 0);
    takt_chip_write(PSC, 0);
    takt_chip_write(ARR, (uint32_t)((uint64_t)timer_hz * STEP_SLOT_NS / NS_PER_S) - 1U);
    takt_chip_write(EGR, EGR_UPDATE);
    takt_chip_write(DIER, DIER_REQUEST);
}

bool takt_step_output_open(struct step_output *s, enum gpio_port port, uint32_t timer_hz,
                           uint32_t cycle_us)
{
    memset(s, 0, sizeof *s);
    if (!takt_step_slots_init(&s->slots, cycle_us))
        return false;
    set_pins(port);
    set_timer(timer_hz);
    return set_stream(s, port);
}

/*
 * In the buffer that is not being sent. They change at the start of a cycle; all of the
 * controller's is behind that.
 */
static void begin_slots(struct step_output *s)
{
    const bool second = (takt_chip_read(STREAM_CR) & CR_SECOND) != 0;

    takt_step_slots_begin(&s->slots, s->levels[second ? 0 : 1]);
}

static bool pulse(void *context, const struct step_pulse *pulse)
{
    struct step_output *s = context;

    if (s->slots.word == NULL)
        begin_slots(s);
    return takt_step_slots_add(&s->slots, pulse);
}

struct step_port takt_step_output_get_port(struct step_output *s)
{
    return (struct step_port){.pulse = pulse, .context = s};
}

/*
 * The timer begins with the first cycle and keeps step with the others: all clocks come from one.
 */
void takt_step_output_begin(struct step_output *s)
{
    if (s->runs)
        return;
    s->runs = true;
    takt_chip_write(CR1, CR1_ON);
}

void takt_step_output_end(struct step_output *s)
{
    const uint16_t *word;

    if (s->slots.word == NULL)
        begin_slots(s);
    word = s->slots.word;
    takt_step_slots_take(&s->slots);
    peripherals_write_back(word, s->slots.slots * sizeof *word);
}
