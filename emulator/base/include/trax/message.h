/* Messages to the user, on standard error: "PROGRAM: error: TEXT". On a terminal the kind is in colour, unless NO_COLOR
   is set (no-color.org) or TERM is "dumb". */
#ifndef TRAX_MESSAGE_H
#define TRAX_MESSAGE_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum trax_message_kind { TRAX_MESSAGE_ERROR, TRAX_MESSAGE_WARNING, TRAX_MESSAGE_NOTE } trax_message_kind;

/* Erases the progress line first. A note that the process has printed before is not printed again. */
__attribute__((format(printf, 3, 4))) void trax_message(const char *program, trax_message_kind kind, const char *format,
                                                        ...);

/* Whether text to this descriptor may be coloured. */
bool trax_has_colours(int descriptor);

#ifdef __cplusplus
}
#endif

#endif
