/*
 * What the code itself guarantees, told where it is relied on: a precondition that a header states,
 * an index within its ring, a result within its range, a state that cannot be. It is checked in
 * every build, images too. An invariant that is broken means that nothing the controller holds can
 * be trusted, so it stops there.
 *
 * Never on what comes from outside (a program, a frame, a file, an operator): that is an error with
 * a text.
 */
#ifndef TAKT_BASE_ASSERT_H
#define TAKT_BASE_ASSERT_H

/* Images leave the text out: file and line say it. */
#ifdef TAKT_ASSERT_WITHOUT_TEXT
#define TAKT_ASSERT_TEXT(condition) ((const char *)0)
#else
#define TAKT_ASSERT_TEXT(condition) #condition
#endif

/* The condition has no side effects, and costs no loop in the control cycle. */
#define TAKT_ASSERT(condition)                                                                     \
    ((condition) ? (void)0 : takt_assert_failed(__FILE__, __LINE__, TAKT_ASSERT_TEXT(condition)))

/*
 * The safe stop: setpoints end at once, and the drives brake on their own. The port's function, or,
 * where it has none, that of hal/stop: a program on a desk says what is broken and aborts, an image
 * traps. text: NULL in an image.
 */
_Noreturn void takt_assert_failed(const char *file, int line, const char *text);

#endif
