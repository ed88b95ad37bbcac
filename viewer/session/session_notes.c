// session_notes.c - notes on the file that is shown: beside it on disk, with the state they were
// made in
#include "session/session.h"

#include "app/adjust.h"
#include "app/app.h"
#include "app/notes.h"
#include "cli/program/notes_file.h"
#include "cli/program/state_line.h"

#include <relume/relight/tone.h>

#include <stdio.h>
#include <string.h>
#include <time.h>

// ---------------------------------------------------------------- the list

// What goes wrong is said, and the list stays as it is on disk.
static relume_status report_status(struct session *s, relume_status status)
{
    messages_stop(&s->messages);
    if (status)
        session_say(s, "%.200s",
                    s->messages.notice[0] ? s->messages.notice : relume_status_text(status));
    return status == RELUME_ENOMEM ? status : RELUME_OK;
}

static relume_status open_list(struct session *s)
{
    const struct relume_notes_file file = notes_file_of(s->document.pack, s->document.name);
    relume_notes *list = NULL;
    const relume_status status = relume_notes_open(&list, s->document.path, &file, s->log);
    return status ? status : notes_create(&s->app.notes, list);
}

relume_status session_notes_show(struct session *s)
{
    relume_status status = RELUME_OK;
    if (s->app.noting || !s->document.pack) {
        s->app.noting = false;
        if (!s->document.pack)
            session_say(s, "notes are on pictures of a file; there is none");
        return RELUME_OK;
    }
    messages_listen(&s->messages);
    if (!s->app.notes)
        status = open_list(s);
    s->app.noting = !status;
    s->app.panel |= s->app.noting;
    return report_status(s, status);
}

static relume_status save_list(struct session *s)
{
    struct relume_log bare = s->log ? *s->log : (struct relume_log){0};
    bare.leave_unnoted = true;  // the list was read from where it goes
    return relume_notes_save(s->app.notes->list, s->document.path, &bare);
}

relume_status session_notes_add(struct session *s)
{
    char state[STATE_LINE_MOST], created[32];
    struct notes *n = s->app.notes;
    struct relume_note note = notes_drawn(&s->app);
    relume_status status = session_state_line(state, sizeof state, s);
    if (status == RELUME_ENOMEM)
        return status;
    note.state = status ? NULL : state;
    const time_t now = time(NULL);
    struct tm parts;
    if (gmtime_r(&now, &parts) && strftime(created, sizeof created, "%Y-%m-%dT%H:%M:%SZ", &parts))
        note.created = created;
    messages_listen(&s->messages);
    status = relume_notes_add(n->list, &note, s->log);
    n->places = 0;
    if (!status) {
        n->chosen = relume_notes_count(n->list) - 1;
        status = save_list(s);
    }
    return report_status(s, status);
}

relume_status session_notes_save(struct session *s)
{
    messages_listen(&s->messages);
    return report_status(s, save_list(s));
}

// ---------------------------------------------------------------- back to a note

// One entry of a line; what this file cannot show is left out.
static void show_entry(struct session *s, const struct state_entry *e, bool *lit)
{
    struct app_state *now = &s->app.now;
    const char *name = e->option + 2, *expected;
    char words[APP_SPEC];
    if (!strcmp(name, "light")) {
        if (!session_light(s, e->value, !*lit))
            *lit = true;
        return;
    }
    if (!strcmp(name, "pass"))
        for (int p = 0; p < app_passes(&s->app); p++)
            if (!strcmp(relume_pass_name((enum relume_pass)p), e->value))
                now->pass = (enum relume_pass)p;
    if (!strcmp(name, "tone"))
        for (int t = 0; relume_tones[t]; t++)
            if (!strcmp(relume_tones[t]->name, e->value))
                now->tone = t;
    int view;
    if (!strcmp(name, "view") && sscanf(e->value, "%d", &view) == 1 && view >= 0 &&
        view < s->app.file.views && now->camera.framing == RELUME_FRAME_VIEW)
        now->camera.view = view;
    snprintf(words, sizeof words, "%s %s", name, e->value);
    for (char *c = words; *c; c++)
        *c = *c == ',' ? ' ' : *c;
    (void)adjust_say(now, words, &expected);
}

relume_status session_notes_back(struct session *s)
{
    enum { MOST = 256 };
    static struct state_entry entry[MOST];
    static char buffer[STATE_LINE_MOST];
    const struct relume_note *note = relume_notes_get(s->app.notes->list, s->app.notes->chosen);
    int n;
    bool lit = false;
    if (!note->state || state_line_read(entry, &n, MOST, buffer, note->state, NULL)) {
        session_say(s, "this note keeps no light");
        return RELUME_OK;
    }
    messages_listen(&s->messages);
    app_stand_still(&s->app);
    s->app.now.pass = RELUME_PASS_COLOUR;
    s->app.now.exposure_ev = 0;
    for (int i = 0; i < n; i++)
        show_entry(s, &entry[i], &lit);
    return report_status(s, RELUME_OK);
}
