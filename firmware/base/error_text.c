#include "error_text.h"

#include "error.h"

#define TAKT_ERROR_TEXT(name, text) text,
static const char *const texts[TAKT_ERROR_TOTAL] = {TAKT_ERRORS(TAKT_ERROR_TEXT)};
#undef TAKT_ERROR_TEXT

/* None is used. */
const uint8_t takt_error_text_pairs[][2] = {{0, 0}};

const uint8_t *takt_error_text_find(unsigned index)
{
    return (const uint8_t *)texts[index];
}
