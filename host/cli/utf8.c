#include "cli/utf8.h"

size_t utf8_length(const char *text)
{
    const unsigned char *at = (const unsigned char *)text;
    static const struct {
        unsigned char mask, begin, least,
            most; /* of the second byte: no long forms, no surrogates, none above the last */
    } forms[] = {
        {0x80, 0x00, 0, 0},       {0xe0, 0xc0, 0x80, 0xbf}, {0xff, 0xe0, 0xa0, 0xbf},
        {0xff, 0xed, 0x80, 0x9f}, {0xf0, 0xe0, 0x80, 0xbf}, {0xff, 0xf0, 0x90, 0xbf},
        {0xff, 0xf4, 0x80, 0x8f}, {0xf8, 0xf0, 0x80, 0xbf},
    };
    static const unsigned char lengths[] = {1, 2, 3, 3, 3, 4, 4, 4};

    for (size_t i = 0; i < sizeof forms / sizeof forms[0]; i++) {
        if ((at[0] & forms[i].mask) != forms[i].begin)
            continue;
        if (at[0] == 0xc0 || at[0] == 0xc1 || at[0] > 0xf4 ||
            (lengths[i] > 1 && (at[1] < forms[i].least || at[1] > forms[i].most)))
            return 0;
        for (size_t k = 2; k < lengths[i]; k++) {
            if ((at[k] & 0xc0U) != 0x80U)
                return 0;
        }
        return lengths[i];
    }
    return 0;
}
