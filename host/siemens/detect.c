/* What tells that a program is written in Siemens' language. */
#include "siemens/scan.h"
#include "siemens/siemens.h"

#include <string.h>

static bool begins_so(const char *text)
{
    static const char *const orders[] = {
        "%_N_",      "MCALL",      "MSG(",      "PROC ",      "DEF REAL ", "DEF INT ", "DEF BOOL ",
        "DEF CHAR ", "DEF STRING", "DEF AXIS ", "DEF FRAME ", "EXTERN ",   "CASE(",    "CYCLE8"};

    for (size_t i = 0; i < sizeof orders / sizeof orders[0]; i++) {
        if (text[0] == orders[i][0] && strncmp(text, orders[i], strlen(orders[i])) == 0)
            return true;
    }
    return false;
}

/* Up to a comment. */
static void copy_capitals(char *to, size_t size, const char *from)
{
    size_t i = 0;

    for (; i + 1 < size && from[i] != '\0' && from[i] != ';'; i++)
        to[i] = (char)(from[i] >= 'a' && from[i] <= 'z' ? from[i] - 'a' + 'A' : from[i]);
    to[i] = '\0';
}

bool siemens_tells(const struct line *l)
{
    char text[256];

    copy_capitals(text, sizeof text, l->text);
    const char *at = text;

    if (*at == 'N' && scan_is_digit(at[1]))
        at += 1 + strspn(at + 1, "0123456789 ");
    const bool parameter =
        at[0] == 'R' && scan_is_digit(at[1]) && at[1 + strspn(at + 1, "0123456789 ")] == '=';

    const bool begins = begins_so(at);
    const bool arc =
        strchr(text, '(') == NULL && strchr(text, '#') == NULL && strstr(text, "CR=") != NULL;

    text[strcspn(text, "(")] = '\0';
    return parameter || begins || arc || strstr(text, "T=\"") != NULL ||
           strstr(text, "GOTOF ") != NULL || strstr(text, "GOTOB ") != NULL;
}
