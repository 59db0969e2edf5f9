#include "page/page_data.h"

#include <stdlib.h>
#include <string.h>

/* Ticks between two looks at tables and bus, and at an object dictionary. */
#define SLOW_TICKS   15
#define OBJECT_TICKS 8

/* Between two points of the way that has been travelled. */
#define POINT_US 4000

bool page_data_open(struct page_data *data, size_t tools_max)
{
    struct page_job *job = &data->link->job;

    page_peaks_init(&data->peaks, data->setup->cycle_us, POINT_US);
    data->drive = -1;
    job->tools_max = tools_max;
    job->tools = calloc(tools_max > 0 ? tools_max : 1, sizeof *job->tools);
    data->source.tools = calloc(tools_max > 0 ? tools_max : 1, sizeof *job->tools);
    return job->tools != NULL && data->source.tools != NULL;
}

static void end_drawing(struct page_data *data)
{
    if (!data->is_drawing)
        return;
    (void)pthread_join(data->thread, NULL);
    data->is_drawing = false;
    free(data->source.text);
    data->source.text = NULL;
}

void page_data_close(struct page_data *data)
{
    atomic_store(&data->path.is_to_end, true);
    end_drawing(data);
    page_path_close(&data->path);
    page_path_close(&data->ready);
    free(data->source.tools);
    free(data->link->job.tools);
    page_text_free(&data->frame);
    page_text_free(&data->other);
    page_text_free(&data->tables);
}

static void *draw(void *context)
{
    struct page_data *data = context;

    data->owner.draw(data->owner.context, &data->source, &data->path);
    page_path_finish(&data->path);
    atomic_store(&data->is_drawn, true);
    return NULL;
}

/* The program as it is now. False: there is none, or no memory for it. */
static bool copy_program(struct page_data *data)
{
    const char *text;
    size_t size;
    bool good;

    panel_host_lock(data->panel);
    good = data->owner.get_program(data->owner.context, &text, &size);
    data->source.text = good ? malloc(size > 0 ? size : 1) : NULL;
    if (data->source.text != NULL)
        memcpy(data->source.text, text, size);
    data->source.size = size;
    panel_host_unlock(data->panel);
    return data->source.text != NULL;
}

static void start_drawing(struct page_data *data)
{
    data->is_stale = false;
    data->path_crc = data->snapshot.value[REGISTER_PROGRAM_CRC];
    data->path_size = data->snapshot.value[REGISTER_PROGRAM_SIZE];
    if (!copy_program(data))
        return;
    atomic_store(&data->is_drawn, false);
    data->is_drawing =
        page_path_open(&data->path) && pthread_create(&data->thread, NULL, draw, data) == 0;
    if (!data->is_drawing) {
        page_path_close(&data->path);
        free(data->source.text);
        data->source.text = NULL;
    }
}

void page_data_describe_path(const struct page_data *data, struct page_text *text)
{
    page_text_clear(text);
    page_text_add(text, "{\"path\":[%u,%u,%zu,", data->path_size, data->path_crc,
                  data->ready.count);
    page_text_add_string(text, data->ready.problem);
    page_text_add(text, "]}");
}

static void show_path(struct page_data *data)
{
    end_drawing(data);
    page_path_close(&data->ready);
    data->ready = data->path;
    data->path.point = NULL;
    page_data_describe_path(data, &data->other);
    data->listener.tell_all(data->listener.context, &data->other);
}

/*
 * The way is drawn anew for another program, and, between two runs, when offsets or tools have
 * changed.
 */
static void keep_path(struct page_data *data)
{
    const uint32_t *value = data->snapshot.value;
    const bool is_other = value[REGISTER_PROGRAM_CRC] != data->path_crc ||
                          value[REGISTER_PROGRAM_SIZE] != data->path_size ||
                          (data->is_stale && value[REGISTER_STATE] == PANEL_IDLE);

    if (data->is_drawing && atomic_load(&data->is_drawn))
        show_path(data);
    if (!data->is_drawing && is_other && value[REGISTER_PROGRAM_SIZE] > 0 && data->has_tables)
        start_drawing(data);
}

static void take_tables(struct page_data *data, const struct page_job *job)
{
    struct page_source *source = &data->source;

    page_text_clear(&data->other);
    page_json_tables(&data->other, job);
    data->has_tables = true;
    if (!data->is_drawing) {
        source->parameters = job->parameters;
        source->tools_count = job->tools_count;
        memcpy(source->tools, job->tools, job->tools_count * sizeof *job->tools);
    }
    if (strcmp(page_text_get(&data->other), page_text_get(&data->tables)) == 0)
        return;
    data->is_stale = true;
    page_text_clear(&data->tables);
    page_text_add(&data->tables, "%s", page_text_get(&data->other));
    data->listener.tell_all(data->listener.context, &data->tables);
}

static void take_command(struct page_data *data, const struct page_job *job)
{
    const struct page_command command = data->command[0];

    data->commands--;
    memmove(data->command, data->command + 1, data->commands * sizeof data->command[0]);
    page_text_clear(&data->other);
    page_orders_reply(&data->other, command.id, job->problem[0] != '\0' ? job->problem : NULL);
    data->listener.tell_one(data->listener.context, command.page, &data->other);
}

static void take_answer(struct page_data *data, const struct page_job *job)
{
    page_text_clear(&data->other);
    if (data->is_command) {
        take_command(data, job);
    } else if (job->kind == PAGE_JOB_TABLES) {
        take_tables(data, job);
    } else if (job->kind == PAGE_JOB_BUS) {
        page_json_bus(&data->other, &job->bus);
        data->listener.tell_all(data->listener.context, &data->other);
    } else {
        page_json_values(&data->other, &job->values, job->drive);
        data->listener.tell_all(data->listener.context, &data->other);
    }
}

static void ask_command(struct page_data *data, struct page_job *job)
{
    const struct page_command *command = &data->command[0];

    job->kind = command->kind;
    job->drive = command->drive;
    job->object = command->object;
    job->value = command->value;
    job->fault = command->fault;
}

/* False: nothing now. */
static bool ask_in_turn(struct page_data *data, struct page_job *job)
{
    const unsigned turn = data->turn++;

    if (turn % SLOW_TICKS == 0 || turn % SLOW_TICKS == 1) {
        job->kind =
            turn % SLOW_TICKS == 0 || data->setup->drives == 0 ? PAGE_JOB_TABLES : PAGE_JOB_BUS;
        return true;
    }
    if (turn % OBJECT_TICKS != 2)
        return false;
    data->drive = data->listener.next_watched(data->listener.context, data->drive);
    if (data->drive < 0)
        return false;
    job->kind = PAGE_JOB_OBJECTS;
    job->drive = (unsigned)data->drive;
    return true;
}

static void ask(struct page_data *data)
{
    const struct page_job *answer = page_link_answer(data->link);
    struct page_job *job;

    if (answer != NULL)
        take_answer(data, answer);
    job = page_link_next_job(data->link);
    if (job == NULL)
        return;
    data->is_command = data->commands > 0;
    if (data->is_command)
        ask_command(data, job);
    else if (!ask_in_turn(data, job))
        return;
    page_link_ask(data->link);
}

void page_data_tick(struct page_data *data, double time_ms)
{
    struct page_cycle cycle;

    panel_host_look(data->panel, &data->snapshot);
    while (page_link_take(data->link, &cycle))
        page_peaks_add(&data->peaks, &cycle);
    page_text_clear(&data->frame);
    page_json_frame(&data->frame, &data->snapshot, &data->peaks, ++data->number, time_ms);
    page_peaks_clear(&data->peaks);
    ask(data);
    keep_path(data);
}

bool page_data_command(struct page_data *data, const struct page_command *command)
{
    if (data->commands == PAGE_COMMANDS_MAX)
        return false;
    data->command[data->commands++] = *command;
    return true;
}

void page_data_forget(struct page_data *data, unsigned page)
{
    for (unsigned i = 0; i < data->commands; i++) {
        if (data->command[i].page == page)
            data->command[i].page = PANEL_HOST_PAGES;
    }
}

void page_data_greet(const struct page_data *data, struct page_text *text)
{
    page_text_clear(text);
    page_text_add(text, "%s", page_text_get(&data->tables));
}
