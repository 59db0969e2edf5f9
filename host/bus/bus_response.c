#include "bus/bus_response.h"

/* Iterations stop here: no answer later than this is of any use. */
#define RESPONSE_MAX_NS UINT64_C(60000000000)

struct analysis {
    const struct bus_message *messages;
    unsigned count;
    struct frame_times times;
};

static uint64_t longest_ns(const struct analysis *a, unsigned i)
{
    const struct bus_message *message = &a->messages[i];
    const bool fd = a->times.data_ns > 0 && !message->is_remote;
    const struct frame_length worst = frame_bits_worst(message->length, fd);
    return frame_bits_ns(&a->times, &worst);
}

static uint64_t divide_up(uint64_t a, uint64_t b)
{
    return (a + b - 1) / b;
}

/* B_m: the longest frame of lower rank, which may have begun just before. */
static uint64_t blocking_ns(const struct analysis *a, unsigned m)
{
    uint64_t most_ns = 0;
    for (unsigned k = 0; k < a->count; k++)
        if (a->messages[k].id > a->messages[m].id && longest_ns(a, k) > most_ns)
            most_ns = longest_ns(a, k);
    return most_ns;
}

/*
 * Frames of higher rank within a time w, and with_own those of m too:
 *
 *     sum over k of ceil((w + J_k + extra) / T_k) C_k
 */
static uint64_t interference_ns(const struct analysis *a, unsigned m, uint64_t w_ns,
                                uint64_t extra_ns, bool with_own)
{
    uint64_t sum_ns = 0;
    for (unsigned k = 0; k < a->count; k++) {
        const struct bus_message *message = &a->messages[k];
        if (message->id < a->messages[m].id || (with_own && k == m))
            sum_ns += divide_up(w_ns + message->jitter_ns + extra_ns, message->period_ns) *
                      longest_ns(a, k);
    }
    return sum_ns;
}

/*
 * t_m, the longest time the bus is busy at this rank or above:
 *
 *     t = B_m + sum over k and m of ceil((t + J_k) / T_k) C_k
 */
static uint64_t busy_period_ns(const struct analysis *a, unsigned m)
{
    uint64_t before_ns = 0, now_ns = longest_ns(a, m);
    while (now_ns != before_ns && now_ns < RESPONSE_MAX_NS) {
        before_ns = now_ns;
        now_ns = blocking_ns(a, m) + interference_ns(a, m, before_ns, 0, true);
    }
    return now_ns;
}

/*
 * w_m(q), the wait of instance q of the busy period:
 *
 *     w = B_m + q C_m + sum over k of ceil((w + J_k + tau_bit) / T_k) C_k
 */
static uint64_t wait_ns(const struct analysis *a, unsigned m, uint64_t q)
{
    uint64_t fixed_ns = blocking_ns(a, m) + q * longest_ns(a, m);
    uint64_t before_ns = UINT64_MAX, now_ns = fixed_ns;
    while (now_ns != before_ns && now_ns < RESPONSE_MAX_NS) {
        before_ns = now_ns;
        now_ns = fixed_ns + interference_ns(a, m, before_ns, a->times.bit_ns, false);
    }
    return now_ns;
}

/* R_m = max over q of  J_m + w_m(q) - q T_m + C_m,  q = 0 ... ceil((t_m + J_m) / T_m) - 1 */
static uint64_t response_ns(const struct analysis *a, unsigned m)
{
    const struct bus_message *message = &a->messages[m];
    uint64_t busy_ns = busy_period_ns(a, m), worst_ns = 0;
    if (busy_ns >= RESPONSE_MAX_NS)
        return UINT64_MAX;
    uint64_t instances = divide_up(busy_ns + message->jitter_ns, message->period_ns);
    for (uint64_t q = 0; q < instances; q++) {
        uint64_t late_ns = message->jitter_ns + wait_ns(a, m, q) + longest_ns(a, m);
        uint64_t due_ns = q * message->period_ns;
        if (late_ns > due_ns && late_ns - due_ns > worst_ns)
            worst_ns = late_ns - due_ns;
    }
    return worst_ns;
}

double bus_response_utilisation(const struct bus_message messages[], unsigned count,
                                const struct frame_rates *rates)
{
    const struct analysis analysis = {messages, count, frame_bits_times(rates)};
    double sum = 0;
    for (unsigned i = 0; i < count; i++)
        sum += (double)longest_ns(&analysis, i) / (double)messages[i].period_ns;
    return sum;
}

bool bus_response_predict(const struct bus_message messages[], unsigned count,
                          const struct frame_rates *rates, uint64_t worst_ns[])
{
    const struct analysis analysis = {messages, count, frame_bits_times(rates)};
    bool all_bounded = true;
    for (unsigned m = 0; m < count; m++) {
        worst_ns[m] = response_ns(&analysis, m);
        all_bounded = all_bounded && worst_ns[m] != UINT64_MAX;
    }
    return all_bounded;
}
