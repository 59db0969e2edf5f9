/*
 * What pages are sent, as JSON. Lengths mm, angles degrees, times s.
 *
 *     {"hello":...}                       once: the machine, the registers, the drives
 *     {"n":...,"v":[...],"x":[...]}       30 times a second: all registers in counts, peaks of the axes, points of the way
 *     {"tables":...}, {"bus":...}         twice a second: offsets and tools; load, response times, faults
 *     {"objects":...}, {"values":...}     of the drive that the page looks at
 *     {"path":...}                        the way of the program is there, at /path
 */
#ifndef TAKT_PAGE_PAGE_JSON_H
#define TAKT_PAGE_PAGE_JSON_H

#include "page/page_peaks.h"
#include "page/page_setup.h"
#include "page/page_text.h"
#include "panel/snapshot.h"

void page_json_hello(struct page_text *text, const struct page_setup *setup);

/* Without the closing brace: the page's own CONTROL follows. time_ms: of the wall clock. */
void page_json_frame(struct page_text *text, const struct panel_snapshot *snapshot,
                     const struct page_peaks *peaks, uint32_t number, double time_ms);

void page_json_tables(struct page_text *text, const struct page_job *job);
void page_json_bus(struct page_text *text, const struct page_bus *bus);
void page_json_objects(struct page_text *text, const struct page_drive *drive, unsigned number);
void page_json_values(struct page_text *text, const struct page_values *values, unsigned number);

#endif
