#include "simulation/target_setup.h"

#include "cli/message.h"
#include "compiled/compiled.h"
#include "config/correction_file.h"
#include "correction/table_store.h"

#include <stdlib.h>

static bool has_steps(const struct machine *machine)
{
    for (unsigned i = 0; i < AXIS_COUNT; i++) {
        if (machine_axis_is_stepped(&machine->axis[i]))
            return true;
    }
    return false;
}

static bool has_configurations(const struct machine_setup *setup)
{
    bool has = false;

    for (unsigned i = 0; i < MACHINE_SETUP_DRIVES_MAX; i++)
        has = has || setup->drive[i].dcf[0] != '\0';
    return has;
}

enum command_status target_setup_check(const struct session *session)
{
    const struct options *options = session->options;

    if (options->target == NULL && options->image == NULL)
        return STATUS_DONE;
    if (options->target != NULL && !target_is_known(options->target))
        message_command_error("--target %s: m4f, m7 or rv64 is expected", options->target);
    else if (options->target == NULL || options->image == NULL)
        message_command_error("--target and --image belong together; host/run --target NAME builds "
                              "the image and gives both");
    else if (has_steps(&session->setup.machine))
        message_command_error("--target: the image drives axes over CAN alone, and this machine "
                              "has step drives");
    else if (takt_machine_bus_count(&session->setup.machine) > 1)
        message_command_error("--target: the image has one CAN bus, and this machine has %u",
                              takt_machine_bus_count(&session->setup.machine));
    else if (session->correction != NULL && session->correction->geometry != NULL)
        message_command_error("--target: errors of units (unit_table_..., squareness_urad) are not "
                              "for a board: make a volume table of them with takt calibrate "
                              "--compose");
    else if (has_configurations(&session->setup))
        message_command_error("--target: the image is not handed configurations of drives (dcf); "
                              "a board has them in its settings (takt machine --pack)");
    else
        return STATUS_DONE;
    return STATUS_INPUT;
}

/* What is stored of a table is what a target reads. */
static bool add_table(struct target_table *tables, unsigned *count, struct table *table,
                      const char *path, const struct machine *machine, bool is_volume)
{
    struct target_table *stored = &tables[*count];

    if (path[0] == '\0')
        return true;
    if (!correction_file_read(table, path, machine))
        return false;
    stored->is_volume = is_volume;
    stored->size = takt_table_store_size(table);
    stored->bytes = malloc(stored->size);
    if (stored->bytes == NULL)
        return false;
    takt_table_store(table, stored->bytes);
    (*count)++;
    return true;
}

static bool add_tables(struct target_table *tables, unsigned *count,
                       const struct machine_setup *setup)
{
    struct table *table = calloc(1, sizeof *table);
    bool good = table != NULL &&
                add_table(tables, count, table, setup->volume_table, &setup->machine, true);

    for (unsigned i = 0; i < AXIS_COUNT && good; i++)
        good = add_table(tables, count, table, setup->axis_table[i], &setup->machine, false);
    free(table);
    return good;
}

enum command_status target_setup_open(struct target *target, const struct session *session,
                                      const struct can_port *bus)
{
    static _Thread_local struct program_text_reader reader;
    struct target_table tables[TARGET_TABLES_MAX] = {{0}};
    struct target_config config = {
        .name = session->options->target,
        .image = session->options->image,
        .bus = *bus,
        .machine = &session->setup.machine,
        .tools = &session->tools.table,
        .parameters = &session->parameters.values,
        .plan = session->compiled != NULL ? session->compiled->stream : NULL,
        .table = tables,
        .exact_path = session->options->exact_path,
        .block_delete = session->options->block_delete,
        .from_line = session->options->from_line,
    };
    bool good = add_tables(tables, &config.tables, &session->setup);

    program_text_read(&session->program, &reader, &config.program);
    if (!good)
        message_command_error("--target: the correction tables cannot be handed over");
    else if (!target_open(target, &config)) {
        message_command_error("--target %s: %s", config.name, target->problem);
        good = false;
    }
    for (unsigned i = 0; i < config.tables; i++)
        free(tables[i].bytes);
    return good ? STATUS_DONE : STATUS_ENVIRONMENT;
}
