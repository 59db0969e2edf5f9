#include "report/report.h"

#include "report/page.h"
#include "report/recording.h"

#include <errno.h>
#include <stdlib.h>

struct report {
    struct recording recording;
    struct page_texts texts;
};

struct report *report_open(const struct plan_limits *limits)
{
    struct report *r = calloc(1, sizeof *r);
    if (r != NULL && !recording_open(&r->recording, limits)) {
        report_close(r);
        return NULL;
    }
    return r;
}

void report_close(struct report *r)
{
    if (r == NULL)
        return;
    recording_close(&r->recording);
    free(r);
}

void report_add(struct report *r, const struct cycle_record *record, bool rapid)
{
    recording_add(&r->recording, record, rapid);
}

void report_set_map(struct report *r, const char *map_json)
{
    r->texts.map_json = map_json;
}

void report_set_shares(struct report *r, const char *shares_json)
{
    r->texts.shares_json = shares_json;
}

int report_write(struct report *r, FILE *file, const char *summary_json)
{
    trail_finish(&r->recording.trail);
    errno = 0;
    r->texts.summary_json = summary_json;
    if (page_write(file, &r->recording, &r->texts) && fflush(file) == 0)
        return 0;
    return errno != 0 ? errno : EIO;
}

const char *report_get_plots_missing(void)
{
    if (page_has_plots())
        return NULL;
    return "this takt was built without the plotting library, so the report has tables alone; "
           "configure the build "
           "with -DTAKT_PLOTLY_TARBALL=FILE (the package named in host/report/README.md) and build "
           "again";
}
