/*
 * Text that grows, and JSON in it.
 */
#ifndef TAKT_PAGE_PAGE_TEXT_H
#define TAKT_PAGE_PAGE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

/* Bytes left free before the text, for whoever sends it. */
#define PAGE_TEXT_HEAD 32

struct page_text {
    char *room; /* PAGE_TEXT_HEAD bytes, then the text, which ends with a zero; owned */
    size_t length, size;
    bool has_failed; /* out of memory: the text is of no use */
};

void page_text_clear(struct page_text *text);
void page_text_free(struct page_text *text);
/* "" where there is none. */
const char *page_text_get(const struct page_text *text);

__attribute__((format(printf, 2, 3))) void page_text_add(struct page_text *text, const char *format,
                                                         ...);
/* In quotation marks; what is no UTF-8 as '?'. */
void page_text_add_string(struct page_text *text, const char *string);
/* null where it is not finite. */
void page_text_add_number(struct page_text *text, double value);

#endif
