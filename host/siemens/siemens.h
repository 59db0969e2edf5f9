/*
 * The language of Siemens' controllers, line by line, into what the rest of a translation
 * understands.
 */
#ifndef TAKT_HOST_SIEMENS_H
#define TAKT_HOST_SIEMENS_H

#include "translation/translator.h"

/* What Siemens' controllers say in words. */
void siemens_translate(struct translator *t);
/* What the whole text has. */
void siemens_survey(struct survey *s, struct line *l);
void siemens_finish(struct translator *t);
/* Only programs for them have such a line. */
bool siemens_tells(const struct line *l);

#endif
