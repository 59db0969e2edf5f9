#include "config/chain_text.h"

#include "base/point.h"

#include <stdio.h>
#include <string.h>

/* The letters of a text without its spaces. False: they are too many. */
static bool pick_letters(const char *text, char letters[CHAIN_TEXT_MAX])
{
    size_t length = 0;

    for (; *text != '\0' && length + 1 < CHAIN_TEXT_MAX; text++) {
        if (*text != ' ' && *text != '\t')
            letters[length++] = *text;
    }
    letters[length] = '\0';
    return *text == '\0';
}

/* "wCXbYZt": a part, units with one bed among them, a tool. */
static bool is_framed(const char *letters)
{
    const size_t length = strlen(letters);
    const char *bed = strchr(letters, 'b');

    return length >= 3 && letters[0] == 'w' && letters[length - 1] == 't' && bed != NULL &&
           strchr(bed + 1, 'b') == NULL;
}

static const char *add_unit(struct unit_chain *chain, const char *place, const char *first)
{
    const char *letter = strchr(AXIS_LETTERS, *place);
    const uint8_t axis = letter != NULL ? (uint8_t)(letter - AXIS_LETTERS) : AXIS_COUNT;

    if (axis == AXIS_COUNT)
        return "chain: units are X, Y, Z, A, B, C and b, the bed, between w and t";
    if (chain->units == UNIT_CHAIN_MAX || strchr(place + 1, *place) != NULL)
        return "chain: each unit stands in it once, and there are four at most";
    if (axis >= AXIS_LINEAR_COUNT && place != first)
        return "chain: one unit may turn, the one beside w, which bears the part";
    chain->axis[chain->units++] = axis;
    return NULL;
}

const char *chain_text_read(const char *text, uint32_t turn_axis, struct unit_chain *chain)
{
    char letters[CHAIN_TEXT_MAX];

    *chain = (struct unit_chain){0};
    if (text[0] == '\0' && turn_axis < AXIS_COUNT)
        (void)snprintf(letters, sizeof letters, "w%cbXYZt", AXIS_LETTERS[turn_axis]);
    else if (text[0] == '\0')
        (void)snprintf(letters, sizeof letters, "wbXYZt");
    else if (!pick_letters(text, letters))
        letters[0] = '\0';
    if (!is_framed(letters))
        return "chain: expected from the part to the tool, with the bed b, such as w C X b Y Z t";
    for (const char *place = letters + strlen(letters) - 2; place > letters; place--) {
        const char *wrong = NULL;

        if (*place == 'b')
            chain->tool_units = chain->units;
        else
            wrong = add_unit(chain, place, letters + 1);
        if (wrong != NULL)
            return wrong;
    }
    return NULL;
}
