// test_light_list.c - lists of lights as people have them, and the names by which they are paired
#include "test.h"

#include "capture/manifest/light_list.h"
#include "capture/manifest/light_names.h"

static char folder[64], path[96];

static int setup(void **state)
{
    (void)state;
    test_folder(folder);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    test_folder_remove(folder);
    return 0;
}

static relume_status read_bytes(struct light_list *list, const void *bytes, size_t size,
                                const char *ending, struct test_log *log)
{
    test_log_init(log);
    snprintf(path, sizeof path, "%s/x%s", folder, ending);
    test_write(path, bytes, size);
    return light_list_read(list, path, NULL, &log->log);
}

static relume_status read_text(struct light_list *list, const char *text, struct test_log *log)
{
    return read_bytes(list, text, strlen(text), ".txt", log);
}

// The names, apart by bars; "" where there are none.
static void check_names(const struct light_list *list, const char *want, const char *text)
{
    char names[512] = "";
    for (int i = 0; list->name && i < list->count; i++)
        snprintf(names + strlen(names), sizeof names - strlen(names), "%s%s", i ? "|" : "",
                 list->name[i]);
    if (strcmp(names, want))
        fail_msg("'%s': found names '%s', expected '%s'", text, names, want);
}

static void check_lights(const struct light_list *list, const struct relume_vec3 *want, int n,
                         const char *text)
{
    if (list->count != n)
        fail_msg("'%s': found %d lights, expected %d", text, list->count, n);
    for (int i = 0; i < n; i++) {
        const vec3 v = list->vector[i], d = list->direction[i];
        if (vec3_length(vec3_sub(v, want[i])) > 1e-9 * vec3_length(want[i]))
            fail_msg("'%s': light %d is %g %g %g", text, i, v.x, v.y, v.z);
        CHECK_NEAR(vec3_length(d), 1.0, 1e-12);
        CHECK_NEAR(vec3_dot(d, want[i]), vec3_length(want[i]), 1e-9 * vec3_length(want[i]));
    }
}

// Every text is one of three lights that are known, under these names.
static void test_forms(void **state)
{
    static const vec3 lights[] = {{-.6, 0, .8}, {0, .6, .8}, {.8, 0, .6}};
    static const struct {
        const char *text, *names;
    } rows[] = {
        // one name, three numbers
        {"3\na.jpg -.6 0 .8\nb.jpg 0 .6 .8\nc.jpg .8 0 .6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg -.6 0 .8\nb.jpg 0 .6 .8\nc.jpg .8 0 .6", "a.jpg|b.jpg|c.jpg"},
        {"-.6 0 .8\n0 .6 .8\n.8 0 .6\n", ""},
        {"3\n-.6 0 .8\n0 .6 .8\n.8 0 .6\n", ""},
        // line ends, blank lines, marks
        {"3\r\na.jpg -.6 0 .8\r\nb.jpg 0 .6 .8\r\nc.jpg .8 0 .6\r\n", "a.jpg|b.jpg|c.jpg"},
        {"3\ra.jpg -.6 0 .8\rb.jpg 0 .6 .8\rc.jpg .8 0 .6\r", "a.jpg|b.jpg|c.jpg"},
        {"\xef\xbb\xbf"
         "3\na.jpg -.6 0 .8\nb.jpg 0 .6 .8\nc.jpg .8 0 .6",
         "a.jpg|b.jpg|c.jpg"},
        {"\n\n  3  \n\n  a.jpg\t-.6\t0\t.8  \t\n\nb.jpg 0 .6 .8\nc.jpg .8 0 .6\n\x1a",
         "a.jpg|b.jpg|c.jpg"},
        // comments
        {"# lights\n3\n// of a dome\na.jpg -.6 0 .8 # left\nb.jpg 0 .6 .8 // top\nc.jpg .8 0 .6#\n",
         "a.jpg|b.jpg|c.jpg"},
        {"shot #1.jpg -.6 0 .8\nshot #2.jpg 0 .6 .8\nshot #3.jpg .8 0 .6\n",
         "shot #1.jpg|shot #2.jpg|shot #3.jpg"},
        // separators
        {"a.jpg,-.6,0,.8\nb.jpg,0,.6,.8\nc.jpg,.8,0,.6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg, -.6, 0, .8,\nb.jpg, 0, .6, .8,\nc.jpg, .8, 0, .6,\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg;-.6;0;.8\nb.jpg;0;.6;.8\nc.jpg;.8;0;.6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg\t-.6\t0\t.8\nb.jpg\t0\t.6\t.8\nc.jpg\t.8\t0\t.6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg -.6,0,.8\nb.jpg 0,.6,.8\nc.jpg .8,0,.6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg -.6 0 .8\nb.jpg 0,.6,.8\nc.jpg .8, 0, .6\n", "a.jpg|b.jpg|c.jpg"},
        // decimal commas
        {"a.jpg;-0,6;0;0,8\nb.jpg;0;0,6;0,8\nc.jpg;0,8;0;0,6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg\t-0,6\t0,0\t0,8\nb.jpg\t0\t0,6\t0,8\nc.jpg\t0,8\t0\t0,6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg -0,6 0,0 0,8\nb.jpg 0,0 0,6 0,8\nc.jpg 0,8 0,0 0,6\n", "a.jpg|b.jpg|c.jpg"},
        {"a,b.jpg -0,6 0 0,8\nb.jpg 0 ,6 ,8\nc.jpg ,8 0 ,6\n", "a,b.jpg|b.jpg|c.jpg"},
        {"a.jpg \xe2\x88\x92"
         "0,6 0 8e-1\nb.jpg +0 6e-1 ,8\nc.jpg 0,8 -0 0.6\n",
         "a.jpg|b.jpg|c.jpg"},
        // names
        {"\"a b.jpg\" -.6 0 .8\n'c d.jpg' 0 .6 .8\n\"e.jpg\",.8,0,.6\n", "a b.jpg|c d.jpg|e.jpg"},
        {"IMG 0001.jpg -.6 0 .8\nIMG 0002.jpg 0 .6 .8\nIMG_3.jpg .8 0 .6\n",
         "IMG 0001.jpg|IMG 0002.jpg|IMG_3.jpg"},
        {"IMG 0001 -.6 0 .8\nIMG 0002 0 .6 .8\nIMG 0003 .8 0 .6\n", "IMG 0001|IMG 0002|IMG 0003"},
        {"o'clock 3.jpg -.6 0 .8\nx.jpg 0 .6 .8\ny.jpg .8 0 .6\n", "o'clock 3.jpg|x.jpg|y.jpg"},
        {"base\\IMG_1.jpg -.6 0 .8\nC:\\a b\\2.jpg 0 .6 .8\n/x/3.jpg .8 0 .6\n",
         "base\\IMG_1.jpg|C:\\a b\\2.jpg|/x/3.jpg"},
        {"000.png,-.6,0,.8\n001.png,0,.6,.8\n002.png,.8,0,.6\n", "000.png|001.png|002.png"},
        // more columns and texts
        {"a.jpg -.6 0 .8 800\nb.jpg 0 .6 .8 800\nc.jpg .8 0 .6 800\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg -.6 0 .8 left lamp\nb.jpg 0 .6 .8 top\nc.jpg .8 0 .6\n", "a.jpg|b.jpg|c.jpg"},
        {"a.jpg,-.6,0,.8,1,.9,.8\nb.jpg,0,.6,.8,1,.91,.8\nc.jpg,.8,0,.6,1,.9,.81\n",
         "a.jpg|b.jpg|c.jpg"},
        {"a.jpg -.6 0 .8 5\nb.jpg 0 .6 .8\nc.jpg .8 0 .6 5 6\n", "a.jpg|b.jpg|c.jpg"},
        {"12 03 2024 a.jpg -.6 0 .8\n12 03 2024 b.jpg 0 .6 .8\n12 03 2024 c.jpg .8 0 .6\n",
         "12 03 2024 a.jpg|12 03 2024 b.jpg|12 03 2024 c.jpg"},
        // an index
        {"000,-.6,0,.8\n001,0,.6,.8\n002,.8,0,.6\n", "000|001|002"},
        {"1 -.6 0 .8\n2 0 .6 .8\n3 .8 0 .6\n", "1|2|3"},
        {"1,a.jpg,-.6,0,.8\n2,b.jpg,0,.6,.8\n3,c.jpg,.8,0,.6\n", "a.jpg|b.jpg|c.jpg"},
        {"0.25 -.6 0 .8\n0.5 0 .6 .8\n1.5 .8 0 .6\n", ""},
        // titles
        {"filename,x,y,z\na.jpg,-.6,0,.8\nb.jpg,0,.6,.8\nc.jpg,.8,0,.6\n", "a.jpg|b.jpg|c.jpg"},
        {"z,y,x,filename\n.8,0,-.6,a.jpg\n.8,.6,0,b.jpg\n.6,0,.8,c.jpg\n", "a.jpg|b.jpg|c.jpg"},
        {"id;lx;ly;lz;image\n7;-0,6;0;0,8;a b.jpg\n8;0;0,6;0,8;b\n9;0,8;0;0,6;c,d\n",
         "a b.jpg|b|c,d"},
        {"filename dirx diry dirz\nIMG 1.jpg -.6 0 .8\nb.jpg 0 .6 .8\nc.jpg .8 0 .6\n",
         "IMG 1.jpg|b.jpg|c.jpg"},
        {"3\nintensity\tPosition_X\tPosition_Y\tPosition_Z\n5\t-.6\t0\t.8\n5\t0\t.6\t.8\n5\t."
         "8\t0\t.6\n",
         ""},
        {"index,x,y,z\n4,-.6,0,.8\n5,0,.6,.8\n6,.8,0,.6\n", "4|5|6"},
        {"# z y x\n.8 0 -.6\n.8 .6 0\n.6 0 .8\n", ""},
        {"# x y z\na.jpg -.6 0 .8\nb.jpg 0 .6 .8\nc.jpg .8 0 .6\n", "a.jpg|b.jpg|c.jpg"},
        {"\"name\",\"x\",\"y\",\"z\"\n\"a, "
         "b.jpg\",\"-.6\",\"0\",\".8\"\n\"b\",0,.6,.8\n\"c\",.8,0,.6,,\n",
         "a, b.jpg|b|c"},
        // angles in degrees: 36.86989764584402 is acos 0.8
        {"name,theta,phi\na.jpg,36.86989764584402,180\nb.jpg,36.86989764584402,90\n"
         "c.jpg,53.13010235415598,0\n",
         "a.jpg|b.jpg|c.jpg"},
        {"azimuth [deg];elevation [deg];photo\n180;53,13010235415598;a.jpg\n"
         "90;53,13010235415598;b.jpg\n0;36,86989764584402;c.jpg\n",
         "a.jpg|b.jpg|c.jpg"},
        {"# theta phi\na.jpg 36.86989764584402 180\nb.jpg 36.86989764584402 90\n"
         "c.jpg 53.13010235415598 0\n",
         "a.jpg|b.jpg|c.jpg"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct light_list list;
        struct test_log log;
        if (read_text(&list, rows[i].text, &log))
            fail_msg("'%s': %s", rows[i].text, log.text);
        assert_int_equal(log.lines, 0);
        check_lights(&list, lights, 3, rows[i].text);
        check_names(&list, rows[i].names, rows[i].text);
        assert_true(list.unit);
        light_list_free(&list);
    }
}

// Lengths that are not 1.
static void test_positions(void **state)
{
    static const vec3 lights[] = {{-600, 0, 800}, {0, 650, 800}, {800, 0, 620}};
    static const char *const texts[] = {
        "-600 0 800\n0 650 800\n800 0 620\n",
        "a -600 0 800 1\na 0 650 800 1\na 800 0 620 1\n",
        "1 -600 0 800\n2 0 650 800\n3 800 0 620\n",
        "a,-600,0,800,.98,1,1\nb,0,650,800,1,1.01,1\nc,800,0,620,1,1,.99\n",
    };
    (void)state;
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        struct light_list list;
        struct test_log log;
        if (read_text(&list, texts[i], &log))
            fail_msg("'%s': %s", texts[i], log.text);
        check_lights(&list, lights, 3, texts[i]);
        assert_false(list.unit);
        light_list_free(&list);
    }
}

// Every second byte of what `text` becomes is 0.
static size_t widen(char *out, const char *text, bool big)
{
    size_t n = 0;
    for (; *text; text++) {
        out[n + big] = *text;
        out[n + !big] = 0;
        n += 2;
    }
    return n;
}

static void test_utf16(void **state)
{
    static const vec3 lights[] = {{-.6, 0, .8}, {0, .6, .8}};
    static const char text[] = "a b.jpg -.6 0 .8\r\nc.jpg 0 .6 .8\r\n";
    (void)state;
    for (int form = 0; form < 4; form++) {
        char bytes[128];
        const bool big = form & 1, mark = form & 2;
        if (mark)
            memcpy(bytes, big ? "\xfe\xff" : "\xff\xfe", 2);
        const size_t n = 2 * mark + widen(bytes + 2 * mark, text, big);
        struct light_list list;
        struct test_log log;
        CHECK_OK(read_bytes(&list, bytes, n, ".lp", &log));
        check_lights(&list, lights, 2, text);
        check_names(&list, "a b.jpg|c.jpg", text);
        light_list_free(&list);
    }
    struct light_list list;
    struct test_log log;
    CHECK_OK(read_bytes(&list, "\xff\xfe\xe9\0 \0000\0 \0000\0 \0001\0", 16, ".txt", &log));
    check_names(&list, "\xc3\xa9", "U+00E9");
    light_list_free(&list);
}

static void test_counts(void **state)
{
    (void)state;
    struct light_list list;
    struct test_log log;
    CHECK_OK(read_text(&list, "9\na 0 0 1\n", &log));
    assert_int_equal(list.count, 1);
    assert_non_null(strstr(log.text, "promises 9 lights; found 1"));
    light_list_free(&list);
    CHECK_OK(read_text(&list, "1\na 0 0 1\nb 0 1 0\n", &log));
    assert_int_equal(list.count, 2);
    assert_int_equal(log.lines, 1);
    light_list_free(&list);
    static const char titles[] = "Name;Rechts;Oben;Vorn\na;0;0;1\nb;0;1;0\n";
    CHECK_OK(read_bytes(&list, titles, sizeof titles - 1, ".csv", &log));
    check_names(&list, "a|b", "titles in another language");
    light_list_free(&list);
}

static void test_bad(void **state)
{
    static const struct {
        const char *text, *said;
    } rows[] = {
        {"", "no lights"},
        {"\n \n", "no lights"},
        {"3\n", "no lights"},
        {"# only words\n", "no lights"},
        {"x y z\n", "no lights"},
        {"0\n", "line 1; expected the number of lights, 'name x y z' or 'x y z', found '0'"},
        {"-2\na 0 0 1\n", "line 1; expected the number of lights"},
        {"1.5\na 0 0 1\n", "line 1; expected the number of lights"},
        {"a 0 1\n", "line 1; expected the number of lights"},
        {"1 2\na 0 0 1\n", "line 1; expected the number of lights"},
        {"words before lights\na 0 0 1\n", "line 1; expected the number of lights"},
        {"a 0 0 1\n2\n", "line 2; expected 'name x y z' or 'x y z', found '2'"},
        {"1\na 0 1\n", "line 2; expected 'name x y z'"},
        {"1\n\n\na 0 0 1x\n", "line 4; expected 'name x y z'"},
        {"a 0 0 1\nb 0 1 0\nc 0 1\n", "line 3; expected 'name x y z'"},
        {"1\na 0 0 0\n", "line 2; expected a light direction"},
        {"1\na 1e-9 0 0\n", "line 2; expected a light direction"},
        {"1\na nan 0 1\n", "line 2; expected a light direction"},
        {"1\na 0 -inf 1\n", "line 2; expected a light direction"},
        {"1\na 1e300 1e300 1\n", "line 2; expected a light direction"},
        {"1\na 1e999 0 1\n", "line 2; expected a light direction"},
        {"1 2 3 4\n", "numbers 1 to 3 fit a light as well as numbers 2 to 4"},
        {"a 0 0 1 0\n", "numbers 1 to 3 fit a light as well as numbers 2 to 4"},
        {"a 0 1,5,5 1\n", "fit a light as well as"},
        {"a 0 1 2 3\nb 9 1 5 2\nc 1 0 30 7\n", "fit a light as well as"},
        {"0 0 1\na.jpg 0 1 0\n", "line 1 has no name, line 2 has one"},
        {"name,x,y,z\na,0,0,1\nb,0,0\n", "line 3; expected 4 columns as in line 1, found 'b,0,0'"},
        {"name,x,y,z\na,0,0,1,7\n", "line 2; expected 4 columns as in line 1"},
        {"name,x,y,z\na,0,zero,1\n", "line 2; expected numbers in the columns of the light"},
        {"px,py,pz,dx,dy,dz\n1,2,3,0,0,1\n", "line 1; expected one column for each coordinate; "
                                             "found 'px' and 'dx'"},
        {"name,theta_rad,phi_rad\na,1,1\n", "line 1; expected angles in degrees"},
        {"name,theta,phi\na,1.2,0\nb,1.1,3.1\nc,.3,-3\n", "expected degrees, found radians"},
        {"name,elevation,azimuth\na,1.2,0\nb,1.1,3.1\nc,.3,-3\n",
         "expected degrees, found radians"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct light_list list;
        struct test_log log;
        if (read_text(&list, rows[i].text, &log) != RELUME_EFORMAT || log.lines != 1)
            fail_msg("'%s': is read, or refused with %d lines", rows[i].text, log.lines);
        if (!strstr(log.text, rows[i].said) || !strstr(log.text, path))
            fail_msg("'%s': found '%s', expected '%s'", rows[i].text, log.text, rows[i].said);
        assert_null(list.direction);
    }
}

static void test_bad_files(void **state)
{
    (void)state;
    static const char *const binaries[] = {"1\na\0b 0 0 1\n", "\x89PNG\r\n\x1a\n\0\0\0",
                                           "a\1 0 0 1\n\n\n"};
    struct light_list list;
    struct test_log log;
    for (size_t i = 0; i < sizeof binaries / sizeof *binaries; i++) {
        assert_int_equal(read_bytes(&list, binaries[i], 11, ".lp", &log), RELUME_EFORMAT);
        assert_non_null(strstr(log.text, "not a text file"));
        assert_int_equal(log.lines, 1);
    }
    const struct relume_limits two = {.max_lights = 2};
    test_write(path, "3\na 0 0 1\na 0 0 1\na 0 0 1\n", 26);
    assert_int_equal(light_list_read(&list, path, &two, &log.log), RELUME_ELIMIT);
    assert_non_null(strstr(log.text, "3 lights; expected at most 2"));
    assert_int_equal(light_list_read(&list, folder, NULL, &log.log), RELUME_EFORMAT);
    assert_int_equal(light_list_read(&list, "/nowhere/at/all", NULL, &log.log), RELUME_ENOTFOUND);
}

// ---------------------------------------------------------------- names

enum { MOST = 4 };

static relume_status pair(int order[MOST], int *matched, const char *const *names,
                          const char *const *photographs, int n, struct test_log *log)
{
    static const int line[MOST] = {2, 3, 5, 6};
    const struct light_names list = {.path = "list.txt",
                                     .count = n,
                                     .name = names,
                                     .line = line,
                                     .numbered = names[0][0] >= '0' && names[0][0] <= '9' &&
                                                 !strchr(names[0], '.')};
    test_log_init(log);
    return light_names_pair_all(order, matched, &list, photographs, n, &log->log);
}

// Whatever its spelling, each name is that of the photograph with the same digit.
static void test_names(void **state)
{
    static const char *const rows[][2][3] = {
        {{"c1.jpg", "a2.jpg", "b3.jpg"}, {"x/a2.jpg", "x/b3.jpg", "x/c1.jpg"}},
        {{"C1.JPG", "A2.jpg", "B3.Jpg"}, {"a2.jpg", "b3.jpg", "c1.jpg"}},
        {{"c1", "a2", "b3"}, {"a2.jpg", "b3.jpg", "c1.jpg"}},
        {{"c1.tif", "a2.CR2", "b3.png"}, {"a2.jpg", "b3.jpg", "c1.jpg"}},
        {{"base\\c1.jpg", "D:\\q\\a2.jpg", "/r/s/b3.jpg"}, {"a2.jpg", "b3.jpg", "c1.jpg"}},
        {{"left/a.jpg", "mid/a.jpg", "right/a.jpg"},
         {"p/mid/a.jpg", "p/right/a.jpg", "p/left/a.jpg"}},
        // U+00E9 and e with U+0301; Latin-1; Vietnamese
        {{"caf\xc3\xa9"
          "1.jpg",
          "re\xcc\x81"
          "2.jpg",
          "\xc3\x89t\xc3\xa9"
          "3.jpg"},
         {"r\xc3\xa9"
          "2.jpg",
          "E\xcc\x81te\xcc\x81"
          "3.jpg",
          "cafe\xcc\x81"
          "1.jpg"}},
        {{"\xe9"
          "1.jpg",
          "\xe1\xbb\x87"
          "2.jpg",
          "b3.jpg"},
         {"e\xcc\xa3\xcc\x82"
          "2.jpg",
          "b3.jpg",
          "\xc3\x89"
          "1.jpg"}},
        {{"002", "000", "001"}, {"000.png", "001.png", "002.png"}},
        {{"1 right.jpg", "2 left.jpg", "3 top.jpg"}, {"left.jpg", "top.jpg", "right.jpg"}},
        {{"a.b1", "a.b2", "a.b3"}, {"a.b2", "a.b3", "a.b1"}},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        int order[MOST], matched;
        struct test_log log;
        CHECK_OK(pair(order, &matched, rows[i][0], rows[i][1], 3, &log));
        if (matched != 3 || order[0] != 1 || order[1] != 2 || order[2] != 0 || log.lines)
            fail_msg("row %zu: %d names match, order %d %d %d; %s", i, matched, order[0], order[1],
                     order[2], log.text);
    }
}

static void test_bad_names(void **state)
{
    static const char *const photographs[] = {"p/image03.jpg", "p/image04.jpg", "p/image05.jpg"};
    (void)state;
    int order[MOST], matched;
    struct test_log log;
    const char *twice[] = {"image03.jpg", "image04.jpg", "IMAGE03.jpg"};
    assert_int_equal(pair(order, &matched, twice, photographs, 3, &log), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "list.txt: 'image03.jpg' is listed in lines 2 and 5; "
                                     "'image05.jpg' is never listed"));
    // some
    const char *some[] = {"image05.jpg", "other.jpg", "third.jpg"};
    CHECK_OK(pair(order, &matched, some, photographs, 3, &log));
    assert_int_equal(matched, 1);
    assert_int_equal(order[2], 0);
    const struct light_names list = {.path = "list.txt", .count = 3, .name = some};
    assert_int_equal(light_names_refuse(&list, order, photographs, 3, "advice", &log.log),
                     RELUME_EUNFIT);
    assert_string_equal(log.text, "list.txt: names no light for 'image03.jpg', 'image04.jpg', and "
                                  "no photograph is 'other.jpg', 'third.jpg'; advice");
    // none, in order; none, and another number
    const char *none[] = {"a.jpg", "b.jpg", "c.jpg"};
    CHECK_OK(pair(order, &matched, none, photographs, 3, &log));
    assert_int_equal(matched, 0);
    assert_int_equal(order[2], 2);
    assert_non_null(strstr(log.text, "none of the listed images exists"));
    const struct light_names fewer = {.path = "list.txt", .count = 2, .name = none};
    assert_int_equal(light_names_pair_all(order, &matched, &fewer, photographs, 3, &log.log),
                     RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "2 lights; expected 3"));
    // an index
    const char *rising[] = {"1", "2", "3"}, *falling[] = {"1", "3", "2"};
    CHECK_OK(pair(order, &matched, rising, photographs, 3, &log));
    assert_int_equal(log.lines, 0);
    assert_int_equal(order[2], 2);
    assert_int_equal(pair(order, &matched, falling, photographs, 3, &log), RELUME_EUNFIT);
    assert_non_null(strstr(log.text, "line 5 has the index 2 after 3"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_forms), cmocka_unit_test(test_positions),
        cmocka_unit_test(test_utf16), cmocka_unit_test(test_counts),
        cmocka_unit_test(test_bad),   cmocka_unit_test(test_bad_files),
        cmocka_unit_test(test_names), cmocka_unit_test(test_bad_names),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
