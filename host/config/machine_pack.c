#include "config/machine_pack.h"

#include "cli/message.h"
#include "cli/output_file.h"
#include "cli/text.h"
#include "config/configuration_file.h"
#include "config/correction_file.h"
#include "config/machine_file.h"
#include "storage/settings.h"
#include "storage/store.h"

#include <stdlib.h>
#include <string.h>

/* More than any machine with the largest tables takes. */
#define BYTES_MAX 524288U

/* A fresh sector: whatever was stored before is erased with it. */
#define FIRST_SEQUENCE 1U

struct packed {
    uint8_t head[STORE_HEAD_BYTES];
    uint8_t bytes[BYTES_MAX];
};

static bool write_file(const struct packed *packed, size_t size, const char *path, bool is_sector)
{
    struct output_file file;

    if (!output_file_open(&file, path))
        return false;
    if (is_sector)
        (void)fwrite(packed->head, 1, sizeof packed->head, file.stream);
    (void)fwrite(packed->bytes, 1, size, file.stream);
    return output_file_finish(&file) && output_file_place(&file);
}

static void report(const char *path, const struct correction_tables *tables, size_t size)
{
    if (strcmp(path, "-") != 0)
        (void)printf("%s: %zu bytes, %s volume table, %u axis tables\n", path, size,
                     tables != NULL && tables->volume.inputs != 0 ? "a" : "no",
                     tables != NULL ? tables->axes.count : 0);
}

enum command_status machine_pack_write(const struct machine_setup *setup, const char *path,
                                       bool is_sector)
{
    static _Thread_local struct packed packed;
    struct configuration_files files;
    struct correction_tables *tables = NULL;
    enum command_status status = STATUS_ENVIRONMENT;
    size_t size;

    if (!configuration_files_load(&files, setup) || !correction_file_load(&tables, setup)) {
        configuration_files_free(&files);
        return STATUS_INPUT;
    }
    if (tables != NULL && tables->geometry != NULL) {
        message_command_error("errors of units (unit_table_..., squareness_urad) are not for a "
                              "board: make a volume table of them with takt calibrate --compose");
        free(tables);
        configuration_files_free(&files);
        return STATUS_INPUT;
    }
    size =
        takt_settings_pack(&setup->machine, tables, files.dcf, packed.bytes, sizeof packed.bytes);
    if (size == 0) {
        message_command_error("the settings take more than %u bytes", BYTES_MAX);
        status = STATUS_INPUT;
    } else {
        takt_store_make_head(packed.bytes, (uint32_t)size, FIRST_SEQUENCE, packed.head);
        if (write_file(&packed, size, path, is_sector)) {
            report(path, tables, size);
            status = STATUS_DONE;
        }
    }
    free(tables);
    configuration_files_free(&files);
    return status;
}

static void print_volume(const struct grid *grid)
{
    (void)printf("# with a volume table over");
    for (unsigned i = 0; i < grid->inputs; i++)
        (void)printf(" %c (%u points)", AXIS_LETTERS[grid->input[i].axis],
                     (unsigned)grid->input[i].points);
    (void)printf("\n");
}

static void print_tables(const struct correction_tables *tables)
{
    if (tables->volume.inputs != 0)
        print_volume(&tables->volume);
    for (unsigned i = 0; i < tables->axes.count; i++) {
        const struct axis_pair *pair = &tables->axes.pair[i];

        (void)printf("# with a table over %c that corrects %c%s (%u points)\n",
                     AXIS_LETTERS[pair->input], AXIS_LETTERS[pair->corrected],
                     pair->directed ? ", both directions," : "", (unsigned)pair->points);
    }
}

static void print_configurations(const struct machine *machine, const struct concise_dcf *dcf)
{
    uint8_t node[MACHINE_NODES_MAX];

    for (unsigned i = 0; i < AXIS_COUNT; i++)
        node[i] = machine->axis[i].drive_node;
    for (unsigned i = 0; i < MACHINE_GANTRIES_MAX; i++)
        node[AXIS_COUNT + i] = machine->gantry[i].drive_node;
    for (unsigned i = 0; i < MACHINE_NODES_MAX; i++)
        if (dcf[i].bytes != NULL)
            (void)printf("# with a configuration of node %u (%u bytes)\n", (unsigned)node[i],
                         (unsigned)dcf[i].length);
}

static bool begins_with_head(const struct text *text)
{
    return text->length > STORE_HEAD_BYTES && memcmp(text->bytes, "TKS1", 4) == 0;
}

/* The head of a sector says what follows, and must be right. */
static bool skip_head(const struct text *text, const uint8_t **bytes, size_t *size)
{
    uint8_t head[STORE_HEAD_BYTES];

    *bytes = (const uint8_t *)text->bytes;
    *size = text->length;
    if (!begins_with_head(text))
        return true;
    *bytes += STORE_HEAD_BYTES;
    *size -= STORE_HEAD_BYTES;
    takt_store_make_head(*bytes, (uint32_t)*size, FIRST_SEQUENCE, head);
    return memcmp(head, text->bytes, sizeof head) == 0;
}

static enum command_status print_settings(const char *path, const uint8_t *bytes, size_t size)
{
    static _Thread_local struct correction_tables tables;
    static _Thread_local struct machine_setup setup;
    struct concise_dcf dcf[MACHINE_NODES_MAX];
    struct diagnostic wrong;
    char text[DIAGNOSTIC_TEXT_MAX];

    machine_setup_set_default(&setup);
    if (!takt_settings_read(bytes, size, &setup.machine, &tables, dcf, &wrong)) {
        (void)takt_diagnostic_text(&wrong, text);
        message_error(path, 0, 0, "%s", text);
        return STATUS_INPUT;
    }
    print_tables(&tables);
    print_configurations(&setup.machine, dcf);
    machine_file_write(stdout, &setup);
    return STATUS_DONE;
}

enum command_status machine_pack_print(const char *path)
{
    enum command_status status = STATUS_INPUT;
    struct text text;
    const uint8_t *bytes;
    size_t size;

    if (!text_read(&text, path))
        return STATUS_INPUT;
    if (skip_head(&text, &bytes, &size))
        status = print_settings(path, bytes, size);
    else
        message_error(path, 0, 0, "the head of this flash sector does not fit what follows it");
    text_free(&text);
    return status;
}
