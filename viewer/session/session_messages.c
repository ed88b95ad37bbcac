// session_messages.c - what a session has said, and who hears the messages of its log
#include "session/session_messages.h"

#include <stdio.h>

void messages_listen(struct session_messages *m)
{
    m->notice[0] = '\0';
    m->listens = true;
}

void messages_stop(struct session_messages *m)
{
    m->listens = false;
}

bool messages_pass_on(struct session_messages *m, enum relume_level level, const char *text)
{
    const struct relume_log *listener = m->listener;
    if (m->listens)
        snprintf(m->notice, sizeof m->notice, "%s", text);
    if (!listener)
        return false;
    m->listener = NULL;
    listener->message(listener->user, level, text);
    m->listener = listener;
    return true;
}
