// Edits of g-BRDFs and of maps: closed forms, what must come back bit by bit, energy, and lists
// that are damaged or of something else.
#include "made_energy.h"
#include "test.h"

#include "core/base/half.h"
#include "core/base/memory.h"
#include "material/gbrdf/drawing.h"
#include "material/maps/maps.h"
#include "material/model/model_gbrdf.h"

#include <relume/material/edit.h>
#include <sys/stat.h>

// Steps of 5 / 255 from column to column are exact in 8 bits.
enum { RAMP = 52, SIDE = 12 };

static struct relume_image picture(int width, int height, float (*value)(int x, int y))
{
    struct relume_image image;
    CHECK_OK(relume_image_create(&image, width, height, 1));
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            image.data[y * width + x] = value(x, y);
    return image;
}

static float ramp_across(int x, int y)
{
    (void)y;
    return (float)x / (RAMP - 1);
}

static float ramp_down(int x, int y)
{
    return ramp_across(y, x);
}

static float left_half(int x, int y)
{
    (void)y;
    return x < SIDE / 2 ? 1.0f : 0.0f;
}

static float one(int x, int y)
{
    (void)x, (void)y;
    return 1.0f;
}

// An edit in words, names and values by turns, NULL at the end.
static struct relume_edit made_edit(const char *operation, const char *const *words)
{
    struct relume_edit edit = relume_edit_of(relume_edit_operation_find(operation));
    for (; *words; words += 2)
        CHECK_OK(relume_edit_set(&edit, words[0], words[1], NULL));
    return edit;
}
#define edit_of(operation, ...) made_edit(operation, (const char *const[]){__VA_ARGS__, NULL})

static relume_btf_fitted *planted(int size)
{
    relume_btf_fitted *m;
    CHECK_OK(relume_gbrdf_plant(
        &m, relume_gbrdf_plant_params(.size = size, .directions = relume_btf_set_find("coarse"))));
    return m;
}

static relume_edits *list_for(const relume_btf_fitted *m)
{
    relume_edits *edits;
    CHECK_OK(relume_edits_create(&edits, relume_btf_fitted_fingerprint(m)));
    return edits;
}

static relume_btf_fitted *edited(const relume_btf_fitted *m, const relume_edits *edits)
{
    relume_btf_fitted *out;
    CHECK_OK(relume_btf_fitted_edit(&out, m, edits, NULL));
    return out;
}

// The same edit `times` over; its pictures stay the caller's.
static relume_btf_fitted *edited_times(const relume_btf_fitted *m, const struct relume_edit *edit,
                                       int times)
{
    relume_edits *edits = list_for(m);
    for (int i = 0; i < times; i++)
        CHECK_OK(relume_edits_add(edits, edit, NULL));
    relume_btf_fitted *out = edited(m, edits);
    relume_edits_destroy(&edits);
    return out;
}

// ---------------------------------------------------------------- relief

// A plane with a ramp of height 0.1 leans by 0.1 widths over 51 of 52 texels.
static void test_ramp(void **state)
{
    (void)state;
    relume_btf_fitted *m = planted(RAMP);
    const struct gbrdf_maps maps = gbrdf_maps_of(m);
    memset(maps.depth, 0, RAMP * RAMP * sizeof *maps.depth);
    for (int down = 0; down < 2; down++) {
        struct relume_edit e = edit_of("emboss", "height", "0.1");
        e.drawing = picture(RAMP, RAMP, down ? ramp_down : ramp_across);
        relume_btf_fitted *leaning = edited_times(m, &e, 1);
        const double slope = 0.1 * RAMP / (RAMP - 1);
        // down the rows is against y
        const vec3 n = vec3_unit(vec3_of(down ? 0.0 : -slope, down ? slope : 0.0, 1.0));
        const struct gbrdf *g = leaning->prepared;
        for (int y = 1; y < RAMP - 1; y++)
            for (int x = 1; x < RAMP - 1; x++) {
                const float *found = g->texel[y * RAMP + x].normal;
                CHECK_NEAR((double)found[0], n.x, 1e-5);
                CHECK_NEAR((double)found[1], n.y, 1e-5);
                CHECK_NEAR((double)found[2], n.z, 1e-5);
            }
        relume_btf_fitted_destroy(&leaning);
        relume_edit_destroy(&e);
    }
    relume_btf_fitted_destroy(&m);
}

// A white square of 4 x 4 texels in the upper left corner, half of it beside the sample: it goes on
// at the other sides.
static void test_place(void **state)
{
    (void)state;
    relume_btf_fitted *m = planted(SIDE);
    const struct gbrdf_maps before = gbrdf_maps_of(m);
    struct relume_edit e = edit_of("engrave", "height", "0.03", "at", "0,0", "size", "0.3333333");
    e.drawing = picture(7, 7, one);
    relume_btf_fitted *cut = edited_times(m, &e, 1);
    const struct gbrdf_maps after = gbrdf_maps_of(cut);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const bool within = (x < 2 || x >= SIDE - 2) && (y < 2 || y >= SIDE - 2);
            CHECK_NEAR((double)(before.depth[y * SIDE + x] - after.depth[y * SIDE + x]),
                       within ? 0.03 : 0.0, 1e-6);
        }
    relume_btf_fitted_destroy(&cut);
    relume_edit_destroy(&e);
    relume_btf_fitted_destroy(&m);
}

// ---------------------------------------------------------------- materials

// D of GGX over 4, and wider ones from narrower: what falls between cells of a sixteenth of the
// disc is a few per cent of the peak.
static void test_ggx(void **state)
{
    (void)state;
    const double white[3] = {1.0, 1.0, 1.0};
    float made[NDF_VALUES], wide[NDF_VALUES];
    for (int k = 0; k < 3; k++) {
        const double alpha = 0.3 + 0.2 * k, factor = 0.5 + 0.5 * k;
        ndf_ggx(made, alpha, white);
        ndf_ggx(wide, alpha / factor, white);
        ndf_widen(wide, factor);
        for (int i = 0; i < NDF_SIDE * NDF_SIDE; i++) {
            vec3 h;
            if (!ndf_direction(i % NDF_SIDE, i / NDF_SIDE, NDF_SIDE, &h))
                continue;
            const double peak = 0.25 / (M_PI * alpha * alpha),
                         want = 0.25 * alpha * alpha /
                                (M_PI * pow(h.z * h.z * (alpha * alpha - 1.0) + 1.0, 2.0));
            CHECK_NEAR((double)made[3 * i], want, 0.03 * peak);
            CHECK_NEAR((double)wide[3 * i], want, 0.06 * peak);
        }
    }
}

// What changes nothing leaves every bit.
static void test_same(void **state)
{
    (void)state;
    const struct {
        const char *operation, *parameter, *text;
        int times;
    } same[] = {
        {"roughness", "factor", "1", 1},    {"tint", "factors", "1,1,1", 1},
        {"swap", "labels", "0,2", 2},       {"turn", "degrees", "360", 1},
        {"channels", "channels", "RGB", 1}, {"channels", "channels", "GBR", 3},
    };
    relume_btf_fitted *m = planted(SIDE);
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        const struct relume_edit e = edit_of(same[i].operation, same[i].parameter, same[i].text);
        relume_btf_fitted *again = edited_times(m, &e, same[i].times);
        assert_int_equal(relume_btf_fitted_fingerprint(again), relume_btf_fitted_fingerprint(m));
        relume_btf_fitted_destroy(&again);
        if (same[i].times == 1)
            continue;
        relume_btf_fitted *other = edited_times(m, &e, 1);
        assert_int_not_equal(relume_btf_fitted_fingerprint(other),
                             relume_btf_fitted_fingerprint(m));
        relume_btf_fitted_destroy(&other);
    }
    relume_btf_fitted_destroy(&m);
}

// Under a mask the texels beside it keep all that they have, and their materials.
static void test_mask(void **state)
{
    (void)state;
    relume_btf_fitted *m = planted(SIDE);
    const struct gbrdf_maps before = gbrdf_maps_of(m);
    struct relume_edit e = edit_of("tint", "factors", "0.5,0.25,0", "label", "1");
    e.mask = picture(SIDE, SIDE, left_half);
    relume_btf_fitted *half = edited_times(m, &e, 1);
    const struct gbrdf_maps after = gbrdf_maps_of(half);
    int changed = 0;
    assert_int_equal(after.materials, before.materials + 1);
    assert_memory_equal(after.ndf, before.ndf,
                        (size_t)before.materials * NDF_VALUES * sizeof *after.ndf);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const bool within = i % SIDE < SIDE / 2 && before.label[i] == 1;
        changed += within;
        assert_int_equal(after.label[i], within ? before.materials : before.label[i]);
        for (int c = 0; c < 3; c++) {
            const double factor[3] = {0.5, 0.25, 0.0};
            // powers of two are exact
            CHECK_NEAR((double)float_from_half(after.diffuse[3 * i + c]),
                       (double)float_from_half(before.diffuse[3 * i + c]) *
                           (within ? factor[c] : 1.0),
                       0.0);
        }
    }
    assert_true(changed > 0);
    relume_btf_fitted_destroy(&half);
    relume_edit_destroy(&e);
    relume_btf_fitted_destroy(&m);
}

// Whatever is asked for, no more is sent back than comes in, and light and eye may change places.
static void test_energy(void **state)
{
    (void)state;
    struct relume_edit extreme[] = {
        edit_of("tint", "factors", "16,16,16"),
        edit_of("roughness", "factor", "0.1"),
        edit_of("roughness", "factor", "10"),
        edit_of("swap", "labels", "0,1"),
        edit_of("channels", "channels", "BBB", "label", "1"),
        edit_of("turn", "degrees", "77"),
        edit_of("add-material", "roughness", "0.2", "r0", "1", "colour", "1,1,1"),
    };
    relume_btf_fitted *m = planted(4);
    const struct gbrdf_maps maps = gbrdf_maps_of(m);
    memset(maps.depth, 0, 16 * sizeof *maps.depth);
    for (size_t k = 0; k < sizeof extreme / sizeof *extreme; k++) {
        relume_btf_fitted *e = edited_times(m, &extreme[k], 1);
        for (int i = 0; i < 8; i += TEST_SANITIZED ? 3 : 1) {
            const double theta = 0.18 * i;
            const vec3 l =
                vec3_of(sin(theta) * cos(2.0 * i), sin(theta) * sin(2.0 * i), cos(theta));
            const vec3 v = vec3_unit(vec3_of(0.3, 0.2 - 0.1 * i, 0.8));
            float there[3], back[3];
            // the midpoint rule, of lobes that may be as narrow as six of its cells
            const double sent = sent_back(e->prepared, i % 4 + 0.5, i / 4 + 0.5, l, i % 3, 40);
            assert_true(sent <= 1.02);
            gbrdf_evaluate(e->prepared, i % 4 + 0.5, i / 4 + 0.5, v, l, there);
            gbrdf_evaluate(e->prepared, i % 4 + 0.5, i / 4 + 0.5, l, v, back);
            for (int c = 0; c < 3; c++)
                CHECK_NEAR((double)there[c] / l.z, (double)back[c] / v.z, 1e-4);
        }
        relume_btf_fitted_destroy(&e);
    }
    relume_btf_fitted_destroy(&m);
}

// ---------------------------------------------------------------- lists

// One of each, with a drawing and a mask.
static relume_edits *long_list(const relume_btf_fitted *m)
{
    struct relume_edit all[] = {
        edit_of("emboss", "height", "0.01", "at", "0.4,0.6", "size", "0.7"),
        edit_of("engrave", "height", "0.003"),
        edit_of("roughness", "factor", "1.3", "label", "0"),
        edit_of("tint", "factors", "0.9,0.7,1.1"),
        edit_of("channels", "channels", "BRG"),
        edit_of("swap", "labels", "1,2"),
        edit_of("turn", "degrees", "33.3"),
        edit_of("add-material", "roughness", "0.4", "r0", "0.5", "colour", "0.1,0.2,0.3",
                "highlight", "1,0.9,0.8"),
    };
    relume_edits *edits = list_for(m);
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        if (i < 2)
            all[i].drawing = picture(18, 15, ramp_across);
        else if (i != 5)
            all[i].mask = picture(SIDE, SIDE, left_half);
        CHECK_OK(relume_edits_add(edits, &all[i], NULL));
        relume_edit_destroy(&all[i]);
    }
    return edits;
}

static void test_undo(void **state)
{
    (void)state;
    relume_btf_fitted *m = planted(SIDE);
    relume_edits *edits = long_list(m);
    const int count = relume_edits_count(edits);
    uint64_t step[16];
    for (int i = 0; i < count; i++) {
        relume_btf_fitted *e = edited(m, edits);
        step[i] = relume_btf_fitted_fingerprint(e);
        assert_int_equal(relume_btf_fitted_info(e)->edits, count - i);
        assert_int_equal(relume_btf_fitted_info(e)->edits_undone, i);
        relume_btf_fitted_destroy(&e);
        assert_true(relume_edits_undo(edits));
    }
    assert_false(relume_edits_undo(edits));
    relume_btf_fitted *bare = edited(m, edits);
    assert_int_equal(relume_btf_fitted_fingerprint(bare), relume_btf_fitted_fingerprint(m));
    relume_btf_fitted_destroy(&bare);
    for (int i = count - 1; i >= 0; i--) {
        assert_true(relume_edits_redo(edits));
        relume_btf_fitted *e = edited(m, edits);
        assert_int_equal(relume_btf_fitted_fingerprint(e), step[i]);
        relume_btf_fitted_destroy(&e);
    }
    assert_false(relume_edits_redo(edits));
    // what is undone is lost with the next one
    assert_true(relume_edits_undo(edits));
    CHECK_OK(relume_edits_add(edits, relume_edits_get(edits, 3), NULL));
    assert_int_equal(relume_edits_count(edits), count);
    assert_int_equal(relume_edits_undone(edits), 0);
    relume_edits_destroy(&edits);
    relume_btf_fitted_destroy(&m);
}

// Opening applies what is kept there; baked it is the same to the bit.
static void test_kept(void **state)
{
    (void)state;
    char folder[64], file[96], baked[96];
    struct test_log log;
    test_folder(folder);
    test_log_init(&log);
    snprintf(baked, sizeof baked, "%s/baked.exr", folder);
    for (int form = 0; form < 2; form++) {
        relume_btf_fitted *m = planted(SIDE), *opened, *again;
        relume_edits *edits = long_list(m);
        snprintf(file, sizeof file, "%s/found%s", folder, form ? "" : ".exr");
        CHECK_OK(relume_btf_fitted_save(m, file, NULL));
        CHECK_OK(relume_edits_save(edits, file, NULL));
        CHECK_OK(relume_btf_fitted_open(&opened, file, relume_btf_params(.log = &log.log)));
        relume_btf_fitted *want = edited(m, edits);
        assert_int_equal(relume_btf_fitted_fingerprint(opened),
                         relume_btf_fitted_fingerprint(want));
        CHECK_OK(relume_btf_fitted_save(opened, baked, NULL));
        CHECK_OK(relume_btf_fitted_open(&again, baked, NULL));
        assert_int_equal(relume_btf_fitted_fingerprint(again), relume_btf_fitted_fingerprint(want));
        assert_int_equal(relume_btf_fitted_info(again)->edits, 0);
        relume_btf_fitted_destroy(&again);
        CHECK_OK(relume_btf_fitted_open(&again, file, relume_btf_params(.unedited = true)));
        assert_int_equal(relume_btf_fitted_fingerprint(again), relume_btf_fitted_fingerprint(m));
        relume_btf_fitted_destroy(&again);
        relume_btf_fitted_destroy(&opened);
        relume_btf_fitted_destroy(&want);
        relume_edits_destroy(&edits);
        // of another version
        assert_int_equal(relume_edits_open(&edits, file, 1, &log.log), RELUME_EUNFIT);
        assert_non_null(strstr(log.text, "another version"));
        assert_null(edits);
        relume_btf_fitted_destroy(&m);
    }
    test_folder_remove(folder);
}

// Pictures are packed with and without runs.
static float noise(int x, int y)
{
    return (float)((x * 7919 + y * 104729) % 251) / 255.0f;
}

static float mixed(int x, int y)
{
    return x % 40 < 20 ? noise(x, y) : (float)(y % 3) / 2.0f;
}

static void test_packed(void **state)
{
    (void)state;
    float (*const kind[])(int x, int y) = {one, noise, mixed, left_half};
    for (int i = 0; i < 4 * 30; i++) {
        relume_status status;
        struct relume_image image = picture(1 + i * 7 % 160, 1 + i / 4, kind[i % 4]), kept, back;
        CHECK_OK(drawing_keep(&kept, &image));
        char *text = drawing_text(&kept);
        assert_true(drawing_from_text(&back, kept.width, kept.height, text, &status));
        CHECK_OK(status);
        assert_memory_equal(back.data, kept.data,
                            (size_t)kept.width * (size_t)kept.height * sizeof *kept.data);
        relume_image_destroy(&back);
        assert_false(drawing_from_text(&back, kept.width, kept.height + 1, text, &status));
        relume_image_destroy(&image);
        relume_image_destroy(&kept);
        mem_free(text);
    }
}

// Every damage to a list is one sentence, or another good list.
static void test_hostile(void **state)
{
    (void)state;
    char folder[64], file[96], kept[96];
    static char text[32768], bad[32768];
    struct test_log log;
    relume_btf_fitted *m = planted(SIDE);
    relume_edits *edits = long_list(m);
    const uint64_t fingerprint = relume_btf_fitted_fingerprint(m);
    test_folder(folder);
    snprintf(file, sizeof file, "%s/found.exr", folder);
    snprintf(kept, sizeof kept, "%s/found.edits.json", folder);
    CHECK_OK(relume_edits_save(edits, file, NULL));
    relume_edits_destroy(&edits);
    FILE *f = fopen(kept, "rb");
    const size_t size = fread(text, 1, sizeof text, f);
    fclose(f);
    assert_true(size > 500 && size < sizeof text);
    const size_t step = TEST_SANITIZED ? 13 : 1;
    for (size_t n = 0; n < size - 2; n += step) {
        test_log_init(&log);
        test_write(kept, text, n);
        assert_int_equal(relume_edits_open(&edits, file, fingerprint, &log.log), RELUME_EFORMAT);
        assert_int_equal(log.lines, 1);
        assert_null(edits);
    }
    uint32_t seed = 3;
    int good = 0;
    for (size_t n = 0; n < size; n += step) {
        memcpy(bad, text, size);
        bad[n] = "0-9]}\"{,eG/="[test_random(&seed) % 12];
        test_log_init(&log);
        test_write(kept, bad, size);
        const relume_status status = relume_edits_open(&edits, file, fingerprint, &log.log);
        assert_int_equal(log.lines, status != RELUME_OK);
        good += status == RELUME_OK;
        if (!status && good % 16 == 1) {
            relume_btf_fitted *e;
            test_log_init(&log);
            assert_int_equal(relume_btf_fitted_edit(&e, m, edits, &log.log) != RELUME_OK,
                             log.lines);
            relume_btf_fitted_destroy(&e);
        }
        relume_edits_destroy(&edits);
    }
    assert_true(good > 0);
    relume_btf_fitted_destroy(&m);
    test_folder_remove(folder);
}

// Sentences about lists that are JSON, and no list or one that cannot be.
static void test_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
        relume_status status;
    } bad[] = {
        {"[]", "relumeEdits", RELUME_EFORMAT},
        {"{\"relumeEdits\": 2}", "version 1; found 2", RELUME_EUNSUPPORTED},
        {"{\"relumeEdits\": 1, \"fingerprint\": \"xyz\"}", "16 hexadecimal", RELUME_EFORMAT},
        {"{\"relumeEdits\": 1, \"fingerprint\": \"0000000000000001\"}", "operations",
         RELUME_EFORMAT},
        {"{\"relumeEdits\": 1, \"fingerprint\": \"0000000000000001\", \"undone\": 1, "
         "\"operations\": []}",
         "undone", RELUME_EFORMAT},
        {"{\"relumeEdits\": 1, \"fingerprint\": \"0000000000000001\", \"undone\": 0, "
         "\"operations\": [{\"operation\": \"paint\"}]}",
         "operation", RELUME_EFORMAT},
        {"{\"relumeEdits\": 1, \"fingerprint\": \"0000000000000001\", \"undone\": 0, "
         "\"operations\": [{\"operation\": \"roughness\", \"factor\": 1e9}]}",
         "edit 1, roughness: factor; expected 0.1 to 10", RELUME_EFORMAT},
        {"{\"relumeEdits\": 1, \"fingerprint\": \"0000000000000001\", \"undone\": 0, "
         "\"operations\": [{\"operation\": \"roughness\", \"factor\": 2, \"colour\": 1}]}",
         "edit 1, roughness: has no 'colour'", RELUME_EFORMAT},
        {"{\"relumeEdits\": 1, \"fingerprint\": \"0000000000000001\", \"undone\": 0, "
         "\"operations\": [{\"operation\": \"emboss\", \"height\": 0.1, \"at\": [0, 0], \"size\": "
         "1, \"drawing\": {\"width\": 1000000, \"height\": 1, \"packed\": \"\"}}]}",
         "drawing", RELUME_EFORMAT},
    };
    char folder[64], file[96], kept[96];
    struct test_log log;
    test_folder(folder);
    snprintf(file, sizeof file, "%s/maps", folder);
    assert_int_equal(mkdir(file, 0777), 0);
    snprintf(kept, sizeof kept, "%s/maps/edits.json", folder);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        relume_edits *edits;
        test_log_init(&log);
        test_write(kept, bad[i].text, strlen(bad[i].text));
        assert_int_equal(relume_edits_open(&edits, file, 1, &log.log), bad[i].status);
        assert_int_equal(log.lines, 1);
        if (!strstr(log.text, bad[i].says))
            fail_msg("expected '%s' in '%s'", bad[i].says, log.text);
    }
    test_folder_remove(folder);
}

// What the g-BRDF has not.
static void test_unfit(void **state)
{
    (void)state;
    struct test_log log;
    relume_btf_fitted *m = planted(SIDE), *out;
    struct relume_edit deep = edit_of("emboss", "height", "1"),
                       tall = edit_of("emboss", "height", "0.01"),
                       nowhere = edit_of("turn", "degrees", "5"),
                       beside = edit_of("tint", "factors", "2,2,2", "label", "0");
    // a mask that is nearly white, and one of places where the material is not
    nowhere.mask = picture(3, 3, one);
    for (int i = 0; i < 9; i++)
        nowhere.mask.data[i] = 0.49f;
    beside.mask = picture(SIDE, SIDE, one);
    for (int i = 0; i < SIDE * SIDE; i++)
        beside.mask.data[i] = gbrdf_maps_of(m).label[i] == 0 ? 0.0f : 1.0f;
    deep.drawing = picture(1, 1, one);
    tall.drawing = picture(10, 11, one);
    const struct relume_edit unfit[] = {edit_of("tint", "factors", "1,1,1", "label", "3"),
                                        edit_of("swap", "labels", "0,63"),
                                        deep,
                                        tall,
                                        nowhere,
                                        beside};
    for (size_t i = 0; i < sizeof unfit / sizeof *unfit; i++) {
        relume_edits *edits = list_for(m);
        test_log_init(&log);
        for (int k = 0; k < 2; k++)
            CHECK_OK(relume_edits_add(edits, &unfit[i], &log.log));
        assert_int_equal(relume_btf_fitted_edit(&out, m, edits, &log.log), RELUME_EUNFIT);
        assert_int_equal(log.lines, 1);
        assert_null(out);
        relume_edits_destroy(&edits);
    }
    // numbers out of range, also those that no text gives
    struct relume_edit odd = edit_of("tint", "factors", "1,1,1");
    relume_edits *edits = list_for(m);
    assert_int_equal(relume_edit_set(&odd, "factors", "1,2", NULL), RELUME_EINVAL);
    struct relume_edit idle = edit_of("swap", "labels", "1,2");
    assert_int_equal(relume_edit_set(&idle, "labels", "1,1", NULL), RELUME_EINVAL);
    assert_int_equal(relume_edit_set(&odd, "factors", "1,2,nan", NULL), RELUME_EINVAL);
    assert_int_equal(relume_edit_set(&odd, "height", "1", NULL), RELUME_EINVAL);
    CHECK_NEAR(odd.factors[1], 1.0, 0.0);
    odd.factors[1] = (double)INFINITY;
    assert_int_equal(relume_edits_add(edits, &odd, NULL), RELUME_EINVAL);
    relume_edits_destroy(&edits);
    relume_edit_destroy(&deep);
    relume_edit_destroy(&tall);
    relume_edit_destroy(&nowhere);
    relume_edit_destroy(&beside);
    relume_btf_fitted_destroy(&m);
}

// A list is made, kept, read and applied.
static relume_status all_of_it(const relume_btf_fitted *m, const char *file,
                               const struct relume_edit *emboss, const struct relume_edit *rough)
{
    const uint64_t fingerprint = relume_btf_fitted_fingerprint(m);
    relume_edits *edits = NULL, *again = NULL;
    relume_btf_fitted *out = NULL;
    relume_status status = relume_edits_create(&edits, fingerprint);
    if (!status)
        status = relume_edits_add(edits, emboss, NULL);
    if (!status)
        status = relume_edits_add(edits, rough, NULL);
    if (!status)
        status = relume_edits_save(edits, file, NULL);
    if (!status)
        status = relume_edits_open(&again, file, fingerprint, NULL);
    if (!status)
        status = relume_btf_fitted_edit(&out, m, again, NULL);
    assert_int_equal(out == NULL, status != RELUME_OK);
    relume_btf_fitted_destroy(&out);
    relume_edits_destroy(&edits);
    relume_edits_destroy(&again);
    return status;
}

// Every allocation fails once: nothing crashes or, under ASan, leaks, and the status says so.
static void test_memory(void **state)
{
    (void)state;
    char folder[64], file[96];
    relume_btf_fitted *m = planted(SIDE);
    struct relume_edit emboss = edit_of("emboss", "height", "0.1"),
                       rough = edit_of("roughness", "factor", "2");
    emboss.drawing = picture(5, 5, one);
    rough.mask = picture(SIDE, SIDE, left_half);
    test_folder(folder);
    snprintf(file, sizeof file, "%s/found.exr", folder);
    bool all_done = false;
    int n = 0;
    while (!all_done) {
        mem_fail_after(++n);
        const relume_status status = all_of_it(m, file, &emboss, &rough);
        all_done = mem_fail_pending();
        mem_fail_after(0);
        assert_int_equal(status, all_done ? RELUME_OK : RELUME_ENOMEM);
    }
    assert_true(n > 30 && n < 1000);
    relume_edit_destroy(&emboss);
    relume_edit_destroy(&rough);
    relume_btf_fitted_destroy(&m);
    test_folder_remove(folder);
}

// ---------------------------------------------------------------- from photographs

static void test_make(void **state)
{
    (void)state;
    struct relume_image colour, height = picture(RAMP, RAMP, ramp_across);
    CHECK_OK(relume_image_create(&colour, RAMP, RAMP, 3));
    for (int i = 0; i < 3 * RAMP * RAMP; i++)
        colour.data[i] = 0.1f + 0.1f * (float)(i % 3);
    relume_btf_fitted *m;
    CHECK_OK(relume_gbrdf_make(&m, &colour, &height,
                               relume_gbrdf_make_params(.relief = 0.1, .turn_degrees = 45.0)));
    const struct gbrdf_maps maps = gbrdf_maps_of(m);
    assert_int_equal(maps.width, RAMP);
    assert_int_equal(maps.materials, 1);
    for (int i = 0; i < RAMP * RAMP; i++) {
        CHECK_NEAR((double)maps.depth[i], 0.1 * ((i % RAMP) / (RAMP - 1.0) - 0.5), 1e-6);
        // halfs: 2^-11 relative
        CHECK_NEAR((double)float_from_half(maps.rotation[i]), M_PI / 4.0, 5e-4);
        CHECK_NEAR((double)float_from_half(maps.r0[i]), 0.04, 3e-5);
        for (int c = 0; c < 3; c++)
            CHECK_NEAR((double)float_from_half(maps.diffuse[3 * i + c]), 0.1 + 0.1 * c, 2e-4);
    }
    relume_btf_fitted_destroy(&m);
    colour.data[5] = NAN;
    assert_int_equal(relume_gbrdf_make(&m, &colour, &height, NULL), RELUME_EUNFIT);
    assert_int_equal(relume_gbrdf_make(&m, &height, &height, NULL), RELUME_EINVAL);
    assert_int_equal(
        relume_gbrdf_make(&m, &colour, &height, relume_gbrdf_make_params(.roughness = NAN)),
        RELUME_EINVAL);
    relume_image_destroy(&colour);
    relume_image_destroy(&height);
}

// ---------------------------------------------------------------- maps

// A plane of two pixels a unit that is not known in its first row; every second pixel is metal.
static struct relume_maps plane(void)
{
    struct relume_maps m = {.width = RAMP, .height = RAMP, .pixel = 0.5, .gain = 1.0};
    const struct {
        struct relume_image *image;
        int channels;
        float value;
    } maps[] = {
        {&m.normal, 3, 0.0f},     {&m.base_color, 3, 0.25f}, {&m.roughness, 1, 0.5f},
        {&m.metallic, 1, 0.0f},   {&m.specular, 3, 0.125f},  {&m.height_map, 1, 0.0f},
        {&m.confidence, 1, 1.0f},
    };
    for (size_t k = 0; k < sizeof maps / sizeof *maps; k++) {
        CHECK_OK(relume_image_create(maps[k].image, RAMP, RAMP, maps[k].channels));
        for (int i = 0; i < RAMP * RAMP * maps[k].channels; i++)
            maps[k].image->data[i] = maps[k].value;
    }
    for (int i = 0; i < RAMP * RAMP; i++) {
        m.normal.data[3 * i + 2] = i < RAMP ? 0.0f : 1.0f;
        m.metallic.data[i] = (float)(i % 2);
        m.base_color.data[3 * i] = 0.75f;
    }
    CHECK_OK(relume_height_occlusion(&m.occlusion, &m.height_map, m.pixel, 1));
    return m;
}

static relume_status edit_maps(struct relume_maps *m, const struct relume_edit *edit,
                               const struct relume_log *log)
{
    relume_edits *edits;
    CHECK_OK(relume_edits_create(&edits, relume_maps_fingerprint(m)));
    CHECK_OK(relume_edits_add(edits, edit, NULL));
    const relume_status status = relume_maps_edit(m, edits, 1, log);
    relume_edits_destroy(&edits);
    return status;
}

static void test_maps_relief(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const bool down = k % 2 != 0, sunk = k / 2 != 0;
        struct relume_maps m = plane();
        struct relume_edit e = edit_of(sunk ? "engrave" : "emboss", "height", "0.1");
        const double slope = (sunk ? -0.1 : 0.1) * RAMP / (RAMP - 1);
        const vec3 n = vec3_unit(vec3_of(down ? 0.0 : -slope, down ? slope : 0.0, 1.0));
        double mean = 0.0;
        e.drawing = picture(RAMP, RAMP, down ? ramp_down : ramp_across);
        CHECK_OK(edit_maps(&m, &e, NULL));
        for (int i = 0; i < RAMP * RAMP; i++) {
            const float *found = m.normal.data + 3 * i;
            const bool known = i >= RAMP;
            mean += (double)m.height_map.data[i] / (RAMP * RAMP);
            CHECK_NEAR((double)found[0], known ? n.x : 0.0, 1e-5);
            CHECK_NEAR((double)found[1], known ? n.y : 0.0, 1e-5);
            CHECK_NEAR((double)found[2], known ? n.z : 0.0, 1e-5);
        }
        // 0.1 widths of 52 pixels of 0.5, from the first to the last
        const float *z = m.height_map.data;
        CHECK_NEAR((double)(z[RAMP * RAMP - 1] - z[0]), (sunk ? -0.1 : 0.1) * RAMP * 0.5, 1e-5);
        CHECK_NEAR(mean, 0.0, 1e-5);
        relume_edit_destroy(&e);
        relume_maps_destroy(&m);
    }
}

static void test_maps_colours(void **state)
{
    (void)state;
    struct relume_maps m = plane();
    struct relume_edit tint = edit_of("tint", "factors", "0.5,2,4"),
                       rough = edit_of("roughness", "factor", "3"),
                       order = edit_of("channels", "channels", "GBR");
    tint.mask = picture(2, 1, left_half);
    tint.mask.data[1] = 0.0f;
    CHECK_OK(edit_maps(&m, &tint, NULL));
    CHECK_OK(edit_maps(&m, &rough, NULL));
    const int at[2] = {RAMP + 4, RAMP + 5}, beside = RAMP + RAMP - 3;
    for (int k = 0; k < 2; k++) {
        const float *colour = m.base_color.data + 3 * at[k],
                    *specular = m.specular.data + 3 * at[k];
        CHECK_NEAR((double)colour[0], 0.375, 0.0);
        CHECK_NEAR((double)colour[1], 0.5, 0.0);
        CHECK_NEAR((double)colour[2], 1.0, 0.0);
        // paint shines white, metal in its colour
        CHECK_NEAR((double)specular[0], k ? 0.0625 : 0.125, 0.0);
        CHECK_NEAR((double)m.roughness.data[at[k]], 1.0, 0.0);
    }
    CHECK_NEAR((double)m.base_color.data[3 * beside], 0.75, 0.0);
    CHECK_OK(edit_maps(&m, &order, NULL));
    CHECK_NEAR((double)m.base_color.data[3 * at[0]], 0.5, 0.0);
    CHECK_NEAR((double)m.base_color.data[3 * at[0] + 1], 1.0, 0.0);
    CHECK_NEAR((double)m.base_color.data[3 * at[0] + 2], 0.375, 0.0);
    relume_edit_destroy(&tint);
    struct relume_edit gold =
        edit_of("add-material", "roughness", "0.3", "r0", "0.5", "highlight", "1,0.5,0.25");
    CHECK_OK(edit_maps(&m, &gold, NULL));
    CHECK_NEAR((double)m.roughness.data[at[1]], 0.3, 1e-7);
    CHECK_NEAR((double)m.metallic.data[at[1]], 0.0, 0.0);
    CHECK_NEAR((double)m.specular.data[3 * at[1] + 2], 0.125, 1e-7);
    CHECK_NEAR((double)m.base_color.data[3 * at[1]], 0.5, 0.0);
    relume_maps_destroy(&m);
}

static void test_maps_refused(void **state)
{
    (void)state;
    struct relume_maps m = plane();
    const struct relume_edit bad[] = {edit_of("swap", "labels", "0,1"),
                                      edit_of("turn", "degrees", "5"),
                                      edit_of("tint", "factors", "1,1,1", "label", "0")};
    struct test_log log;
    relume_edits *edits;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        test_log_init(&log);
        assert_int_equal(edit_maps(&m, &bad[i], &log.log), RELUME_EUNFIT);
        assert_int_equal(log.lines, 1);
    }
    struct relume_edit black = edit_of("tint", "factors", "2,2,2");
    black.mask = picture(1, 1, one);
    black.mask.data[0] = 0.0f;
    assert_int_equal(edit_maps(&m, &black, NULL), RELUME_EUNFIT);
    relume_edit_destroy(&black);
    CHECK_OK(relume_edits_create(&edits, 5));
    assert_int_equal(relume_maps_edit(&m, edits, 1, &log.log), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "another version"));
    relume_edits_destroy(&edits);
    relume_maps_destroy(&m);
}

// What is written is read again: floats to the bit, heights in millimetres to what a product and
// its inverse leave.
static void test_maps_folder(void **state)
{
    (void)state;
    char folder[64], path[96], file[128];
    struct relume_maps m = plane(), again;
    struct test_log log;
    test_folder(folder);
    for (int mm = 0; mm < 2; mm++) {
        snprintf(path, sizeof path, "%s/maps%d", folder, mm);
        CHECK_OK(relume_maps_write(
            &m, path, relume_maps_write_params(.width_mm = mm ? 70.0 : 0.0, .directx = mm != 0)));
        CHECK_OK(relume_maps_open(&again, path, NULL));
        if (!mm)
            assert_int_equal(relume_maps_fingerprint(&again), relume_maps_fingerprint(&m));
        CHECK_NEAR(again.width_mm, mm ? 70.0 : 0.0, 0.0);
        CHECK_NEAR(again.pixel, m.pixel, 1e-9);
        assert_int_equal(again.directx, mm != 0);
        for (int i = 0; i < RAMP * RAMP; i++)
            CHECK_NEAR((double)again.height_map.data[i], (double)m.height_map.data[i], 1e-6);
        relume_maps_destroy(&again);
        struct relume_edit e = edit_of("emboss", "height", "0.1");
        e.drawing = picture(RAMP, RAMP, ramp_across);
        CHECK_OK(edit_maps(&m, &e, NULL));
        relume_edit_destroy(&e);
    }
    static const char *const files[] = {"maps.json", "height.exr", "specular.exr"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        snprintf(file, sizeof file, "%s/%s", path, files[i]);
        assert_int_equal(truncate(file, 40), 0);
        test_log_init(&log);
        assert_int_not_equal(relume_maps_open(&again, path, &log.log), RELUME_OK);
        assert_int_equal(log.lines, 1);
        assert_null(again.normal.data);
        snprintf(path, sizeof path, "%s/maps0", folder);
    }
    relume_maps_destroy(&m);
    test_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ramp),         cmocka_unit_test(test_place),
        cmocka_unit_test(test_ggx),          cmocka_unit_test(test_same),
        cmocka_unit_test(test_mask),         cmocka_unit_test(test_energy),
        cmocka_unit_test(test_undo),         cmocka_unit_test(test_kept),
        cmocka_unit_test(test_packed),       cmocka_unit_test(test_hostile),
        cmocka_unit_test(test_refused),      cmocka_unit_test(test_unfit),
        cmocka_unit_test(test_make),         cmocka_unit_test(test_memory),
        cmocka_unit_test(test_maps_relief),  cmocka_unit_test(test_maps_colours),
        cmocka_unit_test(test_maps_refused), cmocka_unit_test(test_maps_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
