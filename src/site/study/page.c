// page.c - the page on which a subject chooses: one HTML file with all pictures in it
#include "core/base/infile.h"
#include "core/base/json_write.h"
#include "core/base/log.h"
#include "core/base/memory.h"
#include "core/base/outfile.h"
#include "core/base/params.h"
#include "core/math/base64.h"
#include "core/math/random.h"
#include "site/study/stimuli.h"

#include <stdio.h>
#include <string.h>

// Pictures are grey-framed on mid grey; a pair follows half a second of grey.
static const char head[] =
    "<!doctype html>\n<html lang=\"en\"><meta charset=\"utf-8\"><title>Study</title>\n"
    "<style>\n"
    "body{margin:0;height:100vh;background:#777;color:#fff;font:20px sans-serif;display:flex;"
    "flex-direction:column;align-items:center;justify-content:center}\n"
    "#pair{display:flex;gap:2vw;align-items:center;justify-content:center}\n"
    "#pair img{max-width:47vw;max-height:78vh;cursor:pointer}\n"
    "p{margin:1em}button,a{font:inherit;padding:.5em 1em}a{color:#fff}.wait img{visibility:hidden}"
    "\n</style>\n"
    "<p id=\"text\">Of each two pictures choose one: click on it, or press the left or right arrow "
    "key. <button id=\"start\">Begin</button></p>\n"
    "<div id=\"pair\" class=\"wait\"><img id=\"left\" alt=\"\"><img id=\"right\" alt=\"\"></div>\n"
    "<p id=\"count\"></p>\n<script>\n\"use strict\";\n";
static const char tail[] =
    "const at = id => document.getElementById(id);\n"
    "const rows = [\"subject,trial,question,scene,left,right,chosen,seconds\"];\n"
    "let now = -1, shown = 0, frame = 0, open = false;\n"
    "const field = t => /[\",\\n]/.test(t) ? '\"' + t.replace(/\"/g, '\"\"') + '\"' : t;\n"
    "const film = side => PICTURES[TRIALS[now].scene][TRIALS[now][side]];\n"
    "function draw() {\n"
    "  if (now < 0 || now >= TRIALS.length) return;\n"
    "  for (const side of [\"left\", \"right\"]) {\n"
    "    const f = film(side), src = f[frame % f.length];\n"
    "    if (at(side).src !== src) at(side).src = src;\n"
    "  }\n"
    "  frame++;\n"
    "}\n"
    "function next() {\n"
    "  open = false;\n"
    "  at(\"pair\").className = \"wait\";\n"
    "  if (++now === TRIALS.length) return finish();\n"
    "  at(\"text\").textContent = QUESTIONS[TRIALS[now].question];\n"
    "  at(\"count\").textContent = now + 1 + \" / \" + TRIALS.length;\n"
    "  frame = 0;\n"
    "  draw();\n"
    "  setTimeout(() => { at(\"pair\").className = \"\"; shown = performance.now(); open = true; "
    "}, "
    "500);\n"
    "}\n"
    "function choose(side) {\n"
    "  if (!open) return;\n"
    "  const t = TRIALS[now];\n"
    "  rows.push([SUBJECT, now + 1, field(QUESTIONS[t.question]), SCENES[t.scene], "
    "CONDITIONS[t.left], CONDITIONS[t.right], CONDITIONS[t[side]],\n"
    "    ((performance.now() - shown) / 1000).toFixed(3)].join(\",\"));\n"
    "  next();\n"
    "}\n"
    "function finish() {\n"
    "  const link = document.createElement(\"a\");\n"
    "  link.href = URL.createObjectURL(new Blob([rows.join(\"\\n\") + \"\\n\"], {type: "
    "\"text/csv\"}));\n"
    "  link.download = \"subject\" + SUBJECT + \".csv\";\n"
    "  link.textContent = \"Save the answers\";\n"
    "  at(\"text\").replaceChildren(\"Thank you. \", link);\n"
    "  at(\"count\").textContent = \"\";\n"
    "  link.click();\n"
    "}\n"
    "for (const side of [\"left\", \"right\"]) at(side).onclick = () => choose(side);\n"
    "document.onkeydown = e => { if (e.key === \"ArrowLeft\") choose(\"left\"); if (e.key === "
    "\"ArrowRight\") choose(\"right\"); };\n"
    "at(\"start\").onclick = next;\n"
    "setInterval(draw, 1000 / RATE);\n"
    "</script></html>\n";

static relume_status put_picture(FILE *to, const char *path, const struct relume_log *log)
{
    char *bytes;
    size_t size;
    const relume_status status =
        input_load(&bytes, &size, path, (uint64_t)1 << 28, "a picture of at most 256 MiB", log);
    if (status)
        return status;
    fputs("\"data:image/png;base64,", to);
    base64_print(to, (const uint8_t *)bytes, size);
    fputs("\"", to);
    mem_free(bytes);
    return RELUME_OK;
}

static relume_status put_stimulus(FILE *to, const char *folder, const struct study *s, int scene,
                                  int condition, const struct relume_log *log)
{
    const int frames = s->frames[scene][condition];
    relume_status status = RELUME_OK;
    fputs("[", to);
    for (int i = 0; !status && i < (frames ? frames : 1); i++) {
        char *path =
            frames ? mem_format("%s/%s/%s/%04d.png", folder, s->condition[condition],
                                s->scene[scene], i)
                   : mem_format("%s/%s/%s.png", folder, s->condition[condition], s->scene[scene]);
        if (i)
            fputs(",", to);
        status = path ? put_picture(to, path, log) : RELUME_ENOMEM;
        mem_free(path);
    }
    fputs("]", to);
    return status;
}

// As a script may hold it: an end of the script is none.
static relume_status put_texts(FILE *to, const char *name, const char *const *text, int n)
{
    struct jwriter w = {.file = to, .style = JSON_MARKUP};
    fprintf(to, "const %s = ", name);
    jput_texts(&w, NULL, text, (size_t)n);
    fputs(";\n", to);
    return w.status;
}

// ---------------------------------------------------------------- trials

struct trial {
    int question, scene, left, right;
};

// Every pair once, shuffled (Fisher, Yates), on sides by chance.
static struct trial *trials_of(const struct study *s, int subject, size_t *count)
{
    const size_t pairs = (size_t)s->conditions * (size_t)(s->conditions - 1) / 2;
    *count = pairs * (size_t)s->scenes * (size_t)s->questions;
    struct trial *trial = mem_array(*count, sizeof *trial);
    struct random random = random_stream(s->seed, (uint64_t)subject, 0);
    size_t n = 0;
    if (!trial)
        return NULL;
    for (int q = 0; q < s->questions; q++)
        for (int i = 0; i < s->scenes; i++)
            for (int a = 0; a < s->conditions; a++)
                for (int b = a + 1; b < s->conditions; b++) {
                    const bool turned = random_next(&random) < 0.5;
                    trial[n++] = (struct trial){q, i, turned ? b : a, turned ? a : b};
                }
    for (size_t i = n; i > 1; i--) {
        const size_t k = (size_t)(random_next(&random) * (double)i);
        const struct trial last = trial[i - 1];
        trial[i - 1] = trial[k];
        trial[k] = last;
    }
    return trial;
}

static relume_status put_trials(FILE *to, const struct study *s, int subject)
{
    size_t n;
    struct trial *trial = trials_of(s, subject, &n);
    if (!trial)
        return RELUME_ENOMEM;
    fputs("const TRIALS = [", to);
    for (size_t i = 0; i < n; i++)
        fprintf(to, "%s{question: %d, scene: %d, left: %d, right: %d}", i ? ",\n" : "",
                trial[i].question, trial[i].scene, trial[i].left, trial[i].right);
    fputs("];\n", to);
    mem_free(trial);
    return RELUME_OK;
}

static relume_status put_page(FILE *to, const char *folder, const struct study *s, int subject,
                              const struct relume_log *log)
{
    fputs(head, to);
    fprintf(to, "const SUBJECT = %d, RATE = %.9g;\n", subject, s->frames_per_second);
    relume_status status = put_texts(to, "QUESTIONS", s->question, s->questions);
    if (!status)
        status = put_texts(to, "SCENES", s->scene, s->scenes);
    if (!status)
        status = put_texts(to, "CONDITIONS", s->condition, s->conditions);
    fputs("const PICTURES = [", to);
    for (int i = 0; !status && i < s->scenes; i++) {
        fputs(i ? ",\n[" : "[", to);
        for (int c = 0; !status && c < s->conditions; c++) {
            fputs(c ? ",\n" : "", to);
            status = put_stimulus(to, folder, s, i, c, log);
        }
        fputs("]", to);
    }
    fputs("];\n", to);
    if (!status)
        status = put_trials(to, s, subject);
    fputs(tail, to);
    return status;
}

relume_status relume_study_page(const char *page, const char *folder, int subject,
                                const struct relume_study_params *params)
{
    const struct relume_study_params p = PARAMS(relume_study_params, params);
    struct study *s = mem_zeroed(1, sizeof *s);
    char *text = NULL;
    size_t size = 0;
    if (!s)
        return RELUME_ENOMEM;
    relume_status status = subject >= 0 ? study_read(s, folder, p.log) : RELUME_EINVAL;
    FILE *to = status ? NULL : open_memstream(&text, &size);
    if (!status && !to)
        status = RELUME_ENOMEM;
    if (!status)
        status = put_page(to, folder, s, subject, p.log);
    if (to && (ferror(to) | fclose(to)) && !status)
        status = RELUME_ENOMEM;
    if (!status)
        status = outfile_save(page, text, size, p.log);
    mem_free_libc(text);
    study_free(s);
    mem_free(s);
    return status;
}
