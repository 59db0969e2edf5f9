#include "tables/parameter_file.h"

#include "cli/message.h"
#include "cli/text.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PARAMETER_LINE_MAX 255

static const char *set_parameter(struct parameter_file *file, const char *line)
{
    char *after_number, *after_value;
    long number = strtol(line, &after_number, 10);
    double value = strtod(after_number, &after_value);

    if (after_number == line || after_value == after_number || !isfinite(value) ||
        after_value[strspn(after_value, " \t")] != '\0')
        return "a parameter number and its value are expected";
    if (number < 1 || number > PARAMETER_NUMBER_MAX)
        return "there is no such parameter: numbers go from 1 to 5601";
    if (file->listed[number])
        return "this parameter is given twice";
    file->listed[number] = true;
    return takt_parameters_set(&file->values, (unsigned)number, value)
               ? NULL
               : "too many parameters that are not 0";
}

/* NULL, or what is wrong with the line. */
static const char *read_line(struct parameter_file *file, const char *start, size_t length)
{
    char line[PARAMETER_LINE_MAX + 1];

    if (length > PARAMETER_LINE_MAX)
        return "the line is too long";
    memcpy(line, start, length);
    line[length] = '\0';
    if (line[strspn(line, " \t")] == '\0')
        return NULL;
    return set_parameter(file, line);
}

bool parameter_file_read(struct parameter_file *file, const char *path)
{
    struct text text;
    size_t position = 0, length;
    const char *line;
    uint32_t number = 0;
    unsigned errors = 0;

    *file = (struct parameter_file){0};
    takt_parameters_clear(&file->values);
    if (!text_read(&text, path))
        return false;
    while (text_next_line(&text, &position, &line, &length)) {
        const char *wrong = read_line(file, line, length);

        number++;
        if (wrong == NULL)
            continue;
        message_error(text.name, number, 1, "%s", wrong);
        errors++;
    }
    text_free(&text);
    return errors == 0;
}

static bool is_kept(const struct parameter_file *file, unsigned number)
{
    bool computed = number >= PARAMETER_TOOL_NUMBER && number < PARAMETER_POSITION + 9;

    if (file->listed[number])
        return true;
    return number >= PARAMETER_REFERENCE_1 && !computed &&
           takt_parameters_get(&file->values, number) != 0;
}

/* With as few digits as give the same bits when read. */
static void write_value(FILE *stream, unsigned number, double value)
{
    char text[32];

    for (int digits = 15; digits <= 17; digits++) {
        (void)snprintf(text, sizeof text, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    (void)fprintf(stream, "%u\t%s\n", number, text);
}

void parameter_file_write(FILE *stream, const struct parameter_file *file)
{
    for (unsigned number = 1; number <= PARAMETER_NUMBER_MAX; number++) {
        if (is_kept(file, number))
            write_value(stream, number, takt_parameters_get(&file->values, number));
    }
}
