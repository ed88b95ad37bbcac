// session_messages.h - what a session has said, and who hears the messages of its log
#ifndef VIEWER_SESSION_MESSAGES_H
#define VIEWER_SESSION_MESSAGES_H

#include <relume/base.h>

enum { SESSION_TEXT = 256 };

struct session_messages {
    char last[SESSION_TEXT];            // shown in the panel
    char notice[SESSION_TEXT];          // last message of the log since messages_listen
    bool listens;                       // messages become the notice, too
    const struct relume_log *listener;  // hears messages instead of the terminal; NULL: none
};

// From now on until messages_stop the last message of the log is kept.
void messages_listen(struct session_messages *m);
void messages_stop(struct session_messages *m);
// Hands a message to the listener, which may log messages of its own; false without one.
bool messages_pass_on(struct session_messages *m, enum relume_level level, const char *text);

#endif
