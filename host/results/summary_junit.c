/* The summary as JUnit XML, as CI servers read it: one case a check. */
#include "results/summary.h"

#include "cli/utf8.h"

/* XML 1.0 has no control characters but spaces, and a file name need not be UTF-8. */
static size_t write_character(FILE *stream, const char *text)
{
    const size_t length = utf8_length(text);

    if (length == 0 || (unsigned char)*text < ' ' || *text == 0x7F) {
        (void)fputc('?', stream);
        return 1;
    }
    return fwrite(text, 1, length, stream) == length ? length : 1;
}

static void write_escaped(FILE *stream, const char *text)
{
    while (*text != '\0') {
        switch (*text) {
        case '&':
            (void)fputs("&amp;", stream);
            break;
        case '<':
            (void)fputs("&lt;", stream);
            break;
        case '>':
            (void)fputs("&gt;", stream);
            break;
        case '"':
            (void)fputs("&quot;", stream);
            break;
        default:
            text += write_character(stream, text);
            continue;
        }
        text++;
    }
}

static unsigned count_failures(const struct summary *summary)
{
    unsigned failures = 0;

    for (unsigned i = 0; i < summary->checks; i++)
        failures += summary->check[i].held ? 0 : 1;
    return failures;
}

static void write_case(FILE *stream, const struct summary *summary,
                       const struct summary_check *check)
{
    (void)fputs("  <testcase classname=\"", stream);
    write_escaped(stream, summary->program);
    (void)fprintf(stream, "\" name=\"%s\" time=\"0\"", check->name);
    if (check->held) {
        (void)fputs("/>\n", stream);
        return;
    }
    (void)fprintf(stream, ">\n    <failure message=\"%.9g %s is above %.9g %s\">", check->value,
                  check->unit, check->limit, check->unit);
    write_escaped(stream, summary->fault);
    (void)fputs("</failure>\n  </testcase>\n", stream);
}

/* The program's end, of a run that --until has stopped before it. */
static void write_end(FILE *stream, const struct summary *summary)
{
    (void)fputs("  <testcase classname=\"", stream);
    write_escaped(stream, summary->program);
    (void)fprintf(
        stream,
        "\" name=\"end\" time=\"0\">\n    <skipped message=\"%s came before the program's "
        "end\"/>\n  </testcase>\n",
        summary->outcome == OUTCOME_STOPPED ? "--until" : "an interruption");
}

void summary_write_junit(FILE *stream, const struct summary *summary)
{
    const bool early =
        summary->outcome == OUTCOME_STOPPED || summary->outcome == OUTCOME_INTERRUPTED;
    const unsigned stopped = early ? 1 : 0;

    (void)fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"takt run ", stream);
    write_escaped(stream, summary->program);
    (void)fprintf(
        stream, "\" tests=\"%u\" failures=\"%u\" errors=\"0\" skipped=\"%u\" time=\"%.3f\">\n",
        summary->checks + stopped, count_failures(summary), stopped, summary->wall_time_s);
    for (unsigned i = 0; i < summary->checks; i++)
        write_case(stream, summary, &summary->check[i]);
    if (stopped > 0)
        write_end(stream, summary);
    (void)fputs("</testsuite>\n", stream);
}
