// test_notes.c - notes: measures and profiles in closed form, selectors of other programs, round
// trips
#include "test.h"

#include "in_folder.h"

static const struct relume_notes_file file = {
    .name = "a.exr", .width = 100, .height = 80, .views = 1};

static struct relume_note line(const double (*place)[2], int places)
{
    return (struct relume_note){.kind = RELUME_NOTE_LINE, .places = places, .place = place};
}

static void test_measures(void **state)
{
    (void)state;
    // 3-4-5, at a corner of 90 degrees; far away, where a shoelace sum about 0 would lose digits
    const double far[][2] = {{1e7 + 3, 1e7}, {1e7, 1e7}, {1e7, 1e7 + 4}};
    struct relume_note note = line(far, 3);
    struct relume_note_measures m = relume_note_measure(&note);
    CHECK_NEAR(m.length, 7.0, 1e-12);
    CHECK_NEAR(m.degrees, 90.0, 1e-12);
    assert_true(isnan(m.area));
    note.kind = RELUME_NOTE_POLYGON;
    m = relume_note_measure(&note);
    CHECK_NEAR(m.length, 12.0, 1e-12);
    CHECK_NEAR(m.area, 6.0, 1e-12);
    assert_true(isnan(m.degrees));
    note.kind = RELUME_NOTE_POINT;
    assert_true(isnan(relume_note_measure(&note).length));
}

// A sphere of radius 40 in a picture of 100 x 80: its height along a slanted line that ends where
// no normals are.
static void test_profile_of_a_sphere(void **state)
{
    (void)state;
    const double radius = 40.0, place[][2] = {{30.2, 25.0}, {60.7, 52.3}, {62.0, 40.0}};
    struct relume_image normals, heights;
    CHECK_OK(relume_image_create(&normals, 100, 80, 3));
    CHECK_OK(relume_image_create(&heights, 100, 80, 1));
    for (int i = 0; i < 100 * 80; i++) {
        const double x = i % 100 + 0.5 - 50.0, y = i / 100 + 0.5 - 40.0;
        const double z = sqrt(fmax(radius * radius - x * x - y * y, 0.0));
        const double n[3] = {x / radius, -y / radius, z / radius};
        heights.data[i] = z > 0.0 ? (float)z : NAN;
        for (int c = 0; c < 3; c++)
            normals.data[3 * i + c] = z > 0.0 ? (float)n[c] : 0.0f;
    }
    struct relume_profile by_normals, by_heights;
    CHECK_OK(relume_profile_of_normals(&by_normals, &normals, place, 3));
    CHECK_OK(relume_profile_of_heights(&by_heights, &heights, place, 3));
    assert_int_equal(by_normals.count, by_heights.count);
    const double start = sqrt(radius * radius - 19.8 * 19.8 - 15.0 * 15.0);
    for (int k = 0; k < by_normals.count; k++) {
        const double x = by_normals.place[k][0] - 50.0, y = by_normals.place[k][1] - 40.0;
        const double height = sqrt(radius * radius - x * x - y * y) - start;
        // the trapezium rule and bilinear samples: of second order in a pixel over the radius
        CHECK_NEAR(by_normals.height[k], height, 0.02);
        CHECK_NEAR(by_heights.height[k], height, 0.01);
    }
    CHECK_NEAR(by_normals.along[by_normals.count - 1], hypot(30.5, 27.3) + hypot(1.3, 12.3), 1e-9);
    relume_profile_destroy(&by_normals);
    relume_profile_destroy(&by_heights);
    const double out[][2] = {{50.0, 40.0}, {250.0, 40.0}};
    CHECK_OK(relume_profile_of_heights(&by_heights, &heights, out, 2));
    assert_true(isnan(by_heights.height[by_heights.count - 1]));
    relume_profile_destroy(&by_heights);
    assert_int_equal(relume_profile_of_heights(&by_heights, &heights, out, 1), RELUME_EINVAL);
    const double long_way[][2] = {{0.0, 0.0}, {1e8, 0.0}};
    assert_int_equal(relume_profile_of_heights(&by_heights, &heights, long_way, 2), RELUME_ELIMIT);
    relume_image_destroy(&normals);
    relume_image_destroy(&heights);
}

static relume_status import(relume_notes *notes, const char *items, struct test_log *log)
{
    int added = 0;
    FILE *f = fopen(path_of("page.json"), "w");
    fprintf(f, "{\"type\": \"AnnotationPage\", \"items\": [%s]}", items);
    fclose(f);
    return relume_notes_import(notes, path_of("page.json"), &added, &log->log);
}

#define SVG(shape)                                                                                 \
    "{\"target\": {\"selector\": {\"type\": \"SvgSelector\", \"value\": \"<svg>" shape "</"        \
    "svg>\"}}}"

// What annotation programs write, each with its kind and its last place.
static void test_selectors(void **state)
{
    (void)state;
    static const struct {
        const char *item;
        enum relume_note_kind kind;
        int places;
        double last[2];
    } cases[] = {
        {"{\"target\": \"canvas#xywh=1,2,3,4\"}", RELUME_NOTE_POLYGON, 4, {1, 6}},
        {"{\"target\": {\"source\": \"c\", \"selector\": [{\"type\": \"FragmentSelector\", "
         "\"value\": \"xywh=pixel:10,20,5.5,6\"}]}}",
         RELUME_NOTE_POLYGON,
         4,
         {10, 26}},
        {SVG("<path d='M 1 2 l3,0 0 4 h-3 v1'/>"), RELUME_NOTE_LINE, 5, {1, 7}},
        {SVG("<g><path fill='none' d='M1,2L4,2,4,6z'/></g>"), RELUME_NOTE_POLYGON, 3, {4, 6}},
        {SVG("<polygon points='1,2 3,4 5e0 6'/>"), RELUME_NOTE_POLYGON, 3, {5, 6}},
        {SVG("<polyline points='1,2 3,4'></polyline>"), RELUME_NOTE_LINE, 2, {3, 4}},
        {SVG("<rect x='1' y='2' width='3px' height='4' />"), RELUME_NOTE_POLYGON, 4, {1, 6}},
        {SVG("<line x1='1' y1='2' x2='3' y2='4'/>"), RELUME_NOTE_LINE, 2, {3, 4}},
        {SVG("<circle r='3' cx='7.25' cy = '8'/>"), RELUME_NOTE_POINT, 1, {7.25, 8}},
        {"{\"bodyValue\": \"all of it\", \"target\": \"canvas\"}", RELUME_NOTE_VIEW, 0, {0, 0}},
    };
    struct test_log log;
    test_log_init(&log);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        relume_notes *notes;
        CHECK_OK(relume_notes_create(&notes, &file));
        CHECK_OK(import(notes, cases[i].item, &log));
        assert_int_equal(relume_notes_count(notes), 1);
        const struct relume_note *n = relume_notes_get(notes, 0);
        assert_int_equal(n->kind, cases[i].kind);
        assert_int_equal(n->places, cases[i].places);
        for (int c = 0; n->places && c < 2; c++)
            CHECK_NEAR(n->place[n->places - 1][c], cases[i].last[c], 0.0);
        relume_notes_destroy(&notes);
    }
    assert_int_equal(log.lines, 0);
}

// Left out with a warning, or refused with a sentence.
static void test_bad_selectors(void **state)
{
    (void)state;
    static const char *const unknown[] = {
        SVG("<path d='M1,2 C1,2 3,4 5,6'/>"), SVG("<path d='M1,2 L3,4 M5,6 L7,8'/>"),
        SVG("<rect x='1' y='2' width='3' height='4' transform='rotate(4)'/>"),
        SVG("<path d='M1,2 L3,4'/><path d='M1,2 L3,4'/>"),
        "{\"target\": {\"selector\": {\"type\": \"CssSelector\", \"value\": \"p\"}}}"};
    static const char *const broken[] = {
        SVG("<path d='1,2 L3,4'/>"),
        SVG("<path d='M1 L3,4'/>"),
        SVG("<path d='M1,2'/>"),
        SVG("<path d='M0x1,2 L3,4'/>"),
        SVG("<path d='M1,2 L1e999,4'/>"),
        SVG("<path d='M1,2"),
        SVG("<polygon points='1,2 3'/>"),
        SVG("<circle cx='1'/>"),
        SVG("<path d='M1,2 L3000,4'/>"),
        "{\"target\": \"c#xywh=1,2,3\"}",
        "{\"target\": {\"selector\": {\"type\": \"PointSelector\", \"x\": 1}}}"};
    struct test_log log;
    test_log_init(&log);
    relume_notes *notes;
    CHECK_OK(relume_notes_create(&notes, &file));
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++) {
        log.lines = 0;
        CHECK_OK(import(notes, unknown[i], &log));
        assert_int_equal(log.lines, 1);
    }
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        log.lines = 0;
        assert_int_equal(import(notes, broken[i], &log), RELUME_EFORMAT);
        assert_int_equal(log.lines, 1);
    }
    assert_int_equal(relume_notes_count(notes), 0);
    relume_notes_destroy(&notes);
}

static void empty(relume_notes *notes)
{
    while (relume_notes_count(notes))
        relume_notes_remove(notes, 0);
    CHECK_OK(relume_notes_set_scale(notes, 0.0));
}

static void test_round_trip(void **state)
{
    (void)state;
    const double place[][2] = {{0.1, 1.0 / 3.0}, {99.9999999, 2e-9}, {-3.0, 17.0}};
    const struct relume_note note = {.kind = RELUME_NOTE_POLYGON,
                                     .places = 3,
                                     .place = place,
                                     .text = "\"<script>\\\n \xc3\xa4",
                                     .state = "light=dir,0,0,1&exposure=-1",
                                     .creator = "Ann",
                                     .created = "2026-11-28T12:00:00Z"};
    const struct relume_note view = {.kind = RELUME_NOTE_VIEW, .state = "pan=30"};
    struct test_log log;
    test_log_init(&log);
    relume_notes *notes, *again;
    CHECK_OK(relume_notes_create(&notes, &file));
    CHECK_OK(relume_notes_add(notes, &note, NULL));
    CHECK_OK(relume_notes_add(notes, &view, NULL));
    CHECK_OK(import(notes, "{\"id\": \"x\", \"kept\": {\"by\": 3.25}, \"target\": \"c\"}", &log));
    CHECK_OK(relume_notes_set_scale(notes, 0.125));
    CHECK_OK(relume_notes_save(notes, path_of("a.exr"), NULL));
    CHECK_OK(relume_notes_open(&again, path_of("a.exr"), &file, NULL));
    assert_int_equal(relume_notes_count(again), 3);
    CHECK_NEAR(relume_notes_scale(again), 0.125, 0.0);
    const struct relume_note *n = relume_notes_get(again, 0);
    assert_memory_equal(n->place, place, sizeof place);
    assert_string_equal(n->text, note.text);
    assert_string_equal(n->state, note.state);
    assert_string_equal(n->created, note.created);
    assert_int_equal(relume_notes_get(again, 1)->kind, RELUME_NOTE_VIEW);
    relume_notes_remove(again, 0);
    CHECK_OK(relume_notes_save(again, path_of("a.exr"), NULL));
    FILE *f = fopen(path_of("a.notes.json"), "r");
    char text[4096] = "";
    assert_true(fread(text, 1, sizeof text - 1, f) > 0);
    fclose(f);
    assert_non_null(strstr(text, "\"kept\":{\"by\":3.25}"));
    relume_notes_destroy(&again);
    const struct relume_notes_file other = {
        .name = "a.exr", .width = 100, .height = 81, .views = 1};
    assert_int_equal(relume_notes_open(&again, path_of("a.exr"), &other, &log.log), RELUME_EUNFIT);
    assert_null(again);
    char *inside;
    CHECK_OK(relume_notes_text(&inside, notes));
    empty(notes);
    CHECK_OK(relume_notes_save(notes, path_of("a.exr"), NULL));
    assert_int_equal(access(path_of("a.notes.json"), F_OK), -1);
    relume_notes_destroy(&notes);
    // a list inside the file, which an empty one beside it hides
    const struct relume_notes_file holder = {
        .name = "a.exr", .width = 100, .height = 80, .views = 1, .inside = inside};
    CHECK_OK(relume_notes_open(&again, path_of("a.exr"), &holder, NULL));
    assert_int_equal(relume_notes_count(again), 3);
    empty(again);
    CHECK_OK(relume_notes_save(again, path_of("a.exr"), NULL));
    relume_notes_destroy(&again);
    CHECK_OK(relume_notes_open(&again, path_of("a.exr"), &holder, NULL));
    assert_int_equal(relume_notes_count(again), 0);
    relume_notes_destroy(&again);
    CHECK_OK(relume_notes_unlink(path_of("a.exr"), NULL));
    relume_free(inside);
}

static void test_names(void **state)
{
    (void)state;
    const double place[][2] = {{1, 2}};
    struct relume_note note = {.kind = RELUME_NOTE_POINT, .places = 1, .place = place};
    struct test_log log;
    test_log_init(&log);
    relume_notes *notes;
    CHECK_OK(relume_notes_create(&notes, &file));
    for (int i = 0; i < 3; i++)
        CHECK_OK(relume_notes_add(notes, &note, NULL));
    relume_notes_remove(notes, 1);
    CHECK_OK(relume_notes_add(notes, &note, NULL));
    assert_int_equal(relume_notes_find(notes, "n4"), 2);
    assert_int_equal(relume_notes_find(notes, "n2"), -1);
    note.id = "n4";
    assert_int_equal(relume_notes_add(notes, &note, &log.log), RELUME_EINVAL);
    // the same note comes once; another of the same name gets a new one
    CHECK_OK(import(notes,
                    "{\"id\": \"n1\", \"target\": {\"selector\": {\"type\": \"PointSelector\", "
                    "\"x\": 1, \"y\": 2}}}, {\"id\": \"n4\", \"target\": \"c\"}",
                    &log));
    assert_int_equal(relume_notes_count(notes), 4);
    assert_string_equal(relume_notes_get(notes, 3)->id, "n5");
    assert_int_equal(
        import(notes, "{\"id\": \"a\", \"target\": \"c\"}, {\"id\": \"a\", \"target\": \"c\"}",
               &log),
        RELUME_EFORMAT);
    // behind the largest number that counts, names are looked for
    note.id = "n99999999";
    CHECK_OK(relume_notes_add(notes, &note, NULL));
    note.id = NULL;
    for (int i = 0; i < 2; i++)
        CHECK_OK(relume_notes_add(notes, &note, NULL));
    assert_string_equal(relume_notes_get(notes, 6)->id, "n100000001");
    note.text = "\xff";
    assert_int_equal(relume_notes_add(notes, &note, &log.log), RELUME_EINVAL);
    note.text = NULL;
    note.places = 2;
    assert_int_equal(relume_notes_add(notes, &note, &log.log), RELUME_EINVAL);
    relume_notes_destroy(&notes);
}

#define WKT(text)                                                                                  \
    "{\"target\": {\"selector\": {\"type\": \"WktSelector\", \"value\": \"" text "\"}}}"

static const struct relume_notes_file solid = {
    .name = "a.exr", .solid = true, .box = {{-1, -2, -3}, {1, 2, 3}}};

// Notes on an object: places in space, measures through it, selectors as the drafts of IIIF have
// them; those of pictures and of other objects are none.
static void test_space(void **state)
{
    (void)state;
    // a triangle that leans by 45 degrees: 2 wide, sqrt 8 deep
    static const double place[][2] = {{0, 0}, {2, 0}, {0, 2}}, z[] = {0, 0, 2};
    static const char *const broken[] = {
        WKT("LINESTRING (0 0, 1 1)"),
        WKT("LINESTRING Z (0 0 0, 1 1)"),
        WKT("LINESTRING Z (0 0 0, 1 1 1"),
        WKT("LINESTRING Z (0 0 0, 1 1 1) 2"),
        WKT("POLYGON Z (0 0 0, 1 0 0, 0 1 0)"),
        WKT("POLYGON Z ((0 0 0, 1 0 0, 0 0 0))"),
        WKT("LINESTRING Z (0 0 0, 1 1 nan)"),
        WKT("LINESTRING Z (0 0 0, 1 1 99)"),
        "{\"target\": {\"selector\": {\"type\": \"PointSelector\", \"x\": 1, \"y\": 1}}}",
        "{\"target\": {\"selector\": {\"type\": \"PointSelector\", \"x\": 1, \"y\": 1, \"z\": "
        "\"2\"}}}"};
    struct relume_note note = {.kind = RELUME_NOTE_POLYGON, .places = 3, .place = place, .z = z};
    struct relume_note_measures m = relume_note_measure(&note);
    CHECK_NEAR(m.area, 0.5 * 2.0 * sqrt(8.0), 1e-12);
    CHECK_NEAR(m.length, 2.0 + sqrt(8.0) + sqrt(12.0), 1e-12);
    note.kind = RELUME_NOTE_LINE;
    m = relume_note_measure(&note);
    CHECK_NEAR(m.length, 2.0 + sqrt(12.0), 1e-12);
    CHECK_NEAR(m.degrees, 180.0 / M_PI * acos(1.0 / sqrt(3.0)), 1e-12);

    struct test_log log;
    test_log_init(&log);
    relume_notes *notes, *again;
    CHECK_OK(relume_notes_create(&notes, &solid));
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        log.lines = 0;
        assert_int_equal(import(notes, broken[i], &log), RELUME_EFORMAT);
        assert_int_equal(log.lines, 1);
    }
    CHECK_OK(import(notes, WKT("MULTIPOINT Z (0 0 0)"), &log));
    assert_int_equal(relume_notes_count(notes), 0);
    CHECK_OK(relume_notes_add(notes, &note, NULL));
    note.kind = RELUME_NOTE_POLYGON;
    CHECK_OK(relume_notes_add(notes, &note, NULL));
    CHECK_OK(import(notes, WKT(" polygon z((0 0 0,1 0 .5, 0 1e0 0,0 0 0)) "), &log));
    assert_int_equal(relume_notes_get(notes, 2)->places, 3);
    CHECK_OK(relume_notes_set_scale(notes, 2.5));
    CHECK_OK(relume_notes_save(notes, path_of("a.exr"), NULL));
    CHECK_OK(relume_notes_open(&again, path_of("a.exr"), &solid, NULL));
    CHECK_NEAR(relume_notes_scale(again), 2.5, 0.0);
    for (int i = 0; i < 2; i++) {
        const struct relume_note *n = relume_notes_get(again, i);
        assert_int_equal(n->kind, i ? RELUME_NOTE_POLYGON : RELUME_NOTE_LINE);
        assert_int_equal(n->places, 3);
        assert_memory_equal(n->place, place, sizeof place);
        assert_memory_equal(n->z, z, sizeof z);
    }
    relume_notes_destroy(&again);
    assert_int_equal(relume_notes_write(notes, path_of("a.svg"), RELUME_NOTES_SVG, NULL, &log.log),
                     RELUME_EUNSUPPORTED);
    note.z = NULL;
    assert_int_equal(relume_notes_add(notes, &note, &log.log), RELUME_EINVAL);
    relume_notes_destroy(&notes);
    // what is on an object is neither on a picture nor on another object
    struct relume_notes_file other = solid;
    other.box[1][2] = 3.1;
    assert_int_equal(relume_notes_open(&again, path_of("a.exr"), &other, &log.log), RELUME_EUNFIT);
    assert_int_equal(relume_notes_open(&again, path_of("a.exr"), &file, &log.log), RELUME_EFORMAT);
    memcpy(other.box[1], other.box[0], sizeof other.box[1]);
    assert_int_equal(relume_notes_create(&again, &other), RELUME_EINVAL);
    CHECK_OK(relume_notes_create(&notes, &file));
    note.z = z;
    assert_int_equal(relume_notes_add(notes, &note, &log.log), RELUME_EINVAL);
    relume_notes_destroy(&notes);
    assert_int_equal(unlink(path_of("a.notes.json")), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_measures),   cmocka_unit_test(test_profile_of_a_sphere),
        cmocka_unit_test(test_selectors),  cmocka_unit_test(test_bad_selectors),
        cmocka_unit_test(test_round_trip), cmocka_unit_test(test_names),
        cmocka_unit_test(test_space),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
