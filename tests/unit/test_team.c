// test_team.c - members of a team come to what one machine comes to, and believe no piece
#include "test.h"

#include "format/codebook/books.h"
#include "format/codebook/codebook.h"
#include "format/team/array.h"

#include <pthread.h>

enum { MEMBERS = 3 };

// ---------------------------------------------------------------- threads as members

// All of them run at the same time, as the processes of relume-mpi do.
struct group {
    pthread_barrier_t meeting;
    struct relume_buffer piece[MEMBERS];
    size_t cut;  // bytes that the piece of the last member loses on its way
    int shared;  // steps
};
struct member {
    struct group *group;
    struct relume_team team;
};

static void copy_piece(struct relume_buffer *to, const struct relume_buffer *from)
{
    const struct relume_writer w = relume_buffer_writer(to);
    if (from->size)
        assert_true(w.write(w.user, from->data, from->size, 0));
}

static relume_status share(void *user, const char *what, relume_team_make *make, void *context,
                           struct relume_buffer *pieces)
{
    struct member *m = user;
    struct group *g = m->group;
    assert_true(strlen(what) > 0);
    relume_buffer_destroy(&g->piece[m->team.member]);
    CHECK_OK(make(context, m->team.member, &g->piece[m->team.member]));
    if (m->team.member == MEMBERS - 1)
        g->piece[m->team.member].size -= g->cut;
    if (!m->team.member)
        g->shared++;
    pthread_barrier_wait(&g->meeting);
    for (int i = 0; i < MEMBERS; i++)
        copy_piece(&pieces[i], &g->piece[i]);
    pthread_barrier_wait(&g->meeting);
    return RELUME_OK;
}

static void each_member(struct group *g, void *(*body)(void *member))
{
    struct member member[MEMBERS];
    pthread_t thread[MEMBERS];
    *g = (struct group){.cut = g->cut};
    pthread_barrier_init(&g->meeting, NULL, MEMBERS);
    for (int i = 0; i < MEMBERS; i++) {
        member[i] = (struct member){g, {i, MEMBERS, true, share, &member[i]}};
        pthread_create(&thread[i], NULL, body, &member[i]);
    }
    for (int i = 0; i < MEMBERS; i++)
        pthread_join(thread[i], NULL);
    for (int i = 0; i < MEMBERS; i++)
        relume_buffer_destroy(&g->piece[i]);
    pthread_barrier_destroy(&g->meeting);
}

// ---------------------------------------------------------------- a step

// Each share adds its number, times its digit, in order.
struct digits {
    int member;
    double digit, all;
};

static relume_status begin(void *context, int member)
{
    struct digits *d = context;
    d->member = member;
    d->digit = 0.0;
    return RELUME_OK;
}

static relume_status compute(void *context)
{
    struct digits *d = context;
    d->digit = d->member + 1.0;
    return RELUME_OK;
}

static relume_status add(void *context)
{
    struct digits *d = context;
    d->all = 10.0 * d->all + d->digit;
    return RELUME_OK;
}

static relume_status share_digits(struct digits *d, const struct relume_team *team,
                                  const struct relume_log *log)
{
    struct team_array array = {&d->digit, sizeof d->digit};
    static const struct team_work work = {begin, compute, add};
    return team_share(team, "digits", &work, d, &team_array_bytes, &array, log);
}

static void *find_digits(void *member)
{
    struct member *m = member;
    struct digits d = {.all = 0.0};
    CHECK_OK(share_digits(&d, &m->team, NULL));
    CHECK_NEAR(d.all, 123.0, 0.0);
    return NULL;
}

static void *refuse_digits(void *member)
{
    struct member *m = member;
    struct digits d = {.all = 0.0};
    struct test_log log;
    test_log_init(&log);
    assert_int_equal(share_digits(&d, &m->team, &log.log), RELUME_EDAMAGED);
    assert_non_null(strstr(log.text, "what part 3 has shared (digits) does not fit"));
    CHECK_NEAR(d.all, 12.0, 0.0);
    return NULL;
}

static void test_step(void **state)
{
    (void)state;
    struct digits alone = {.all = 0.0};
    struct group g = {.cut = 0};
    CHECK_OK(share_digits(&alone, NULL, NULL));
    CHECK_NEAR(alone.all, 1.0, 0.0);
    each_member(&g, find_digits);
    g.cut = 1;
    each_member(&g, refuse_digits);
}

// ---------------------------------------------------------------- a codebook

enum { VECTORS = 10000, DIM = 3, CODES = 16 };
static float vectors[VECTORS * DIM];
static relume_codebook *one;

static relume_codebook *train(const struct relume_team *team)
{
    relume_codebook *book;
    CHECK_OK(relume_codebook_train(
        &book, vectors, VECTORS, DIM,
        relume_codebook_params(.codes = CODES, .threads = 1, .max_rounds = 6, .team = team)));
    return book;
}

static void *train_too(void *member)
{
    struct member *m = member;
    relume_codebook *book = train(&m->team);
    const struct relume_codebook_info *got = relume_codebook_info(book),
                                      *want = relume_codebook_info(one);
    assert_memory_equal(got->vectors, want->vectors, CODES * DIM * sizeof *got->vectors);
    assert_true(got->squared_error == want->squared_error && got->rounds == want->rounds);
    relume_codebook_destroy(&book);
    return NULL;
}

static void test_codebook(void **state)
{
    (void)state;
    uint32_t seed = 7;
    struct group g = {.cut = 0};
    for (int i = 0; i < VECTORS * DIM; i++)
        vectors[i] = (float)(test_uniform(&seed) + i % 5);
    one = train(NULL);
    each_member(&g, train_too);
    assert_true(g.shared >= 6);  // each round is shared
    relume_codebook_destroy(&one);
}

// ---------------------------------------------------------------- pieces

static void test_pieces(void **state)
{
    (void)state;
    struct relume_buffer out = {0};
    struct piece_writer to = {.out = &out};
    const double number = 2.5;
    piece_put(&to, "ab", 2);
    piece_put(&to, NULL, 0);
    piece_put(&to, &number, sizeof number);
    assert_false(to.failed);
    struct piece_reader from = {.bytes = out.data, .size = out.size};
    double got = 0.0;
    assert_memory_equal(piece_view(&from, 2), "ab", 2);
    assert_true(piece_get(&from, &got, sizeof got));
    CHECK_NEAR(got, number, 0.0);
    assert_true(!from.damaged && !piece_left(&from) && piece_get(&from, &got, 0));
    assert_false(piece_get(&from, &got, 1));
    assert_true(from.damaged);
    assert_null(piece_view(&from, 0));  // from then on nothing is read
    from = (struct piece_reader){.bytes = out.data, .size = out.size};
    assert_null(piece_view(&from, SIZE_MAX));
    relume_buffer_destroy(&out);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_step),
        cmocka_unit_test(test_codebook),
        cmocka_unit_test(test_pieces),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
