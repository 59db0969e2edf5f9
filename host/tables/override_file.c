#include "tables/override_file.h"

#include "cli/message.h"
#include "tables/rows.h"

#include <stdlib.h>

static bool read_row(struct rows *rows, struct override_file *file, double percent_max)
{
    struct override_row row;

    if (!rows_read_number(rows, "a time in seconds is missing", &row.time_s))
        return false;
    if (row.time_s < 0 || (file->count > 0 && row.time_s < file->row[file->count - 1].time_s))
        return rows_refuse(rows,
                           "the time must not be negative, nor before that of the line above");
    if (!rows_read_number(rows, "per cent are missing behind the time", &row.percent))
        return false;
    if (row.percent < 0 || row.percent > percent_max)
        return rows_refuse(rows, percent_max > 100 ? "the feed override is 0 ... 120 %"
                                                   : "the rapid override is 0 ... 100 %");
    if (!rows_is_at_end(rows))
        return rows_refuse(rows, "nothing may follow time and per cent");
    file->row[file->count++] = row;
    return true;
}

bool override_file_load(struct override_file *file, const char *path, double percent_max)
{
    struct rows rows;
    bool good;

    *file = (struct override_file){.percent = 100};
    if (path == NULL)
        return true;
    if (!rows_open(&rows, path))
        return false;
    file->row = calloc(rows_count_lines(&rows), sizeof *file->row);
    good = file->row != NULL;
    if (!good)
        message_command_error("%s: out of memory", path);
    while (good && rows_next(&rows))
        good = read_row(&rows, file, percent_max);
    rows_close(&rows);
    if (!good)
        override_file_free(file);
    return good;
}

void override_file_free(struct override_file *file)
{
    free(file->row);
    *file = (struct override_file){.percent = 100};
}

double override_file_at(struct override_file *file, double time_s)
{
    while (file->next < file->count && file->row[file->next].time_s <= time_s) {
        file->percent = file->row[file->next].percent;
        file->next++;
    }
    return file->percent;
}
