/*
 * takt as a library: what the commands run, canon, convert, plan, compile and machine do, for
 * programs that call it in their own process.
 *
 *     struct takt_job *job = takt_open(argc, argv, texts, count);      "run", "part.ngc", "--machine", "<mill>"
 *     status = takt_start(job, TAKT_KEEPS_TRACE);
 *     while (status == 0 && !takt_is_over(job))
 *         status = takt_step(job, 1000);
 *     status = takt_finish(job, 0);                                    takt_get_text: the summary as JSON
 *     takt_close(job);
 *
 * The words are those of the command line, so that `takt help` documents them; files may be held in
 * memory instead. Nothing is printed: messages are kept. A status is the exit status of the
 * command. Jobs share nothing: any number may be open, each used by one thread at a time.
 *
 * Only plain declarations stand here: host/python reads this file as it is.
 */
#ifndef TAKT_LIBRARY_LIBRARY_H
#define TAKT_LIBRARY_LIBRARY_H

#include <stddef.h>
#include <stdint.h>

/* What takt_start keeps of a run. */
#define TAKT_KEEPS_TRACE  1
#define TAKT_KEEPS_REPORT 2

/* A text in memory, found under its name wherever a path is asked for. */
struct takt_text {
    const char *name;
    const char *bytes;
    size_t length;
};

struct takt_message {
    const char *kind;      /* error, warning, message, note */
    const char *file;      /* "": about the command line or the environment */
    uint32_t line, column; /* from 1; 0: the file as a whole */
    const char *text;
    const char *cure; /* lines that say what to do; "" for none */
};

/* Axes are X Y Z A B C; mm, of A B C degrees. */
struct takt_state {
    int state; /* 0 drives start, 1 running, 2 stopping after a fault, 3 completed, 4 faulted */
    uint64_t cycles; /* of the program */
    uint64_t cycles_since_power;
    uint32_t block, line;
    uint32_t axes; /* bit i: the machine has axis i */
    double cycle_s;
    double feed_mm_min;
    double override_percent;
    double cmd[6], set[6], act[6];
    uint64_t digest; /* of all setpoints so far */
};

struct takt_inputs {
    double feed_override_percent;  /* 0 ... 120, until the next row of --override */
    double rapid_override_percent; /* 0 ... 100, likewise */
    int feed_hold;                 /* come to rest on the path and stay */
    int single_block;
    uint32_t digital; /* bit i: input P i */
    double analogue[4];
};

struct takt_job;

const char *takt_library_version(void);

/* argv[0] names the command. Everything is copied. NULL: out of memory, or no word. */
struct takt_job *takt_open(int argc, const char *const *argv, const struct takt_text *texts,
                           unsigned count);
void takt_close(struct takt_job *job);

/* Since takt_open. They stay until the next call. */
const struct takt_message *takt_get_messages(const struct takt_job *job, unsigned *count);
/* What the last call that writes a text has written. */
const char *takt_get_text(const struct takt_job *job, size_t *length);

/* Writes the output of canon, convert, plan, compile and machine; that of plan as JSON. */
int takt_write(struct takt_job *job);

/*
 * For run, in this order. keeps: TAKT_KEEPS_... Checks the program, plans it ahead if asked to; the
 * drives boot.
 */
int takt_start(struct takt_job *job, unsigned keeps);
/* Goes on by this many control cycles; fewer where the run is over. */
int takt_step(struct takt_job *job, uint64_t cycles);
int takt_is_over(const struct takt_job *job);
/*
 * Comes to rest and sums up: the text is the JSON of `takt run --json`. cut: not 0: ends before its
 * time, with this status.
 */
int takt_finish(struct takt_job *job, int cut);
/* The text is the HTML of `takt run --report`; behind takt_finish. */
int takt_write_report(struct takt_job *job);

/* Between takt_start and takt_finish. */
void takt_get_state(const struct takt_job *job, struct takt_state *state);
void takt_get_inputs(const struct takt_job *job, struct takt_inputs *inputs);
int takt_set_inputs(struct takt_job *job, const struct takt_inputs *inputs);
/* Faults as of --inject, beside those there are. */
int takt_add_faults(struct takt_job *job, const char *bytes, size_t length);

/* Virtual drives and I/O nodes, by their place. */
unsigned takt_count_drives(const struct takt_job *job);
unsigned takt_get_node(const struct takt_job *job, unsigned drive);
double takt_get_position_mm(const struct takt_job *job, unsigned drive);
/* Bits of the object: 8, 16 or 32; 0: there is none of these. */
unsigned takt_read_object(struct takt_job *job, unsigned drive, uint32_t index, uint32_t sub,
                          uint32_t *value);
/* 0: it cannot be written, or not to this. */
unsigned takt_write_object(struct takt_job *job, unsigned drive, uint32_t index, uint32_t sub,
                           uint32_t value);

/* The trace, a column each: those of --trace. */
unsigned takt_count_columns(const struct takt_job *job);
const char *takt_get_column_name(const struct takt_job *job, unsigned column);
uint64_t takt_count_rows(const struct takt_job *job);
const double *takt_get_column(const struct takt_job *job, unsigned column);
/* The column becomes the caller's, who frees it by takt_free; to be called behind takt_finish. */
double *takt_take_column(struct takt_job *job, unsigned column);
void takt_free(void *memory);

/*
 * run, canon, convert, plan, compile or machine with its options, as the command itself: it prints,
 * and signals end it in order. For a process of its own. Returns the exit status.
 */
int takt_command(int argc, char **argv);

/* The plotting library of reports (JavaScript), for other pages; length 0: built without. */
const unsigned char *takt_get_plotting(size_t *length);

#endif
