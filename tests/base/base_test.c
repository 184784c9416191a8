#include <math.h>
#include <pthread.h>
#include <sched.h>
#include <setjmp.h>
#include <stdatomic.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/color.h"
#include "base/dmath.h"
#include "base/file.h"
#include "base/jobs.h"
#include "base/log.h"
#include "base/memory.h"
#include "base/point_locale.h"
#include "base/utf8.h"
#include "comma_locale.h"

static void elementary_functions_are_accurate(void **state)
{
    (void)state;
    for (int i = -200000; i < 200000; i++) {
        double x = i * 1.37e-3;
        assert_true(fabs(wd_dsin(x) - sin(x)) < 1e-14 && fabs(wd_dcos(x) - cos(x)) < 1e-14);
        assert_true(fabs(wd_dexp(x) / exp(x) - 1.0) < 1e-13);
        double y = exp(x / 3.0);
        assert_true(fabs(wd_dlog(y) - log(y)) < 1e-13);
        double a = sin(x) * 3.0, b = cos(x * 0.7);
        assert_true(fabs(wd_datan2(a, b) - atan2(a, b)) < 1e-13);
        assert_true(fabs(wd_dpow(y, 1.7) / pow(y, 1.7) - 1.0) < 1e-12);
    }
    assert_true(wd_dpow(0.0, 2.0) == 0.0 && wd_dpow(3.0, 0.0) == 1.0);
    assert_true(wd_datan2(0.0, 0.0) == 0.0);
}

static void numbers_have_points(void **state)
{
    (void)state;
    char text[16];
    struct wd_point_locale point;
    locale_t comma = comma_locale(), before;
    if (!comma) {
        print_message("there is no locale with decimal commas: skipped\n");
        skip();
    }
    before = uselocale(comma);
    wd_point_locale_enter(&point);
    snprintf(text, sizeof text, "%.2f", 1.25);
    wd_point_locale_leave(&point);
    assert_string_equal(text, "1.25");
    snprintf(text, sizeof text, "%.2f", 1.25);
    uselocale(before);
    freelocale(comma);
    assert_string_equal(text, "1,25");
}

/* A sink that takes its time, and logs itself. */
struct taker {
    struct wd_log own;
    atomic_int inside;
    unsigned count, overlaps, passed_on;
};

static void take_slowly(void *user, enum wd_log_level level, const char *message)
{
    struct taker *taker = user;
    (void)message;
    if (level == WD_LOG_INFO) {
        taker->passed_on++;
        return;
    }
    taker->overlaps += atomic_fetch_add(&taker->inside, 1) > 0;
    usleep(500);
    if (taker->count++ == 0)
        wd_info(&taker->own, "the first");
    atomic_fetch_sub(&taker->inside, 1);
}

static void log_once(void *user, size_t index)
{
    struct wd_shared_log *shared = user;
    wd_warn(&shared->log, "%zu", index);
}

static void threads_log_one_at_a_time(void **state)
{
    (void)state;
    struct taker taker = {.own = {take_slowly, &taker}};
    struct wd_shared_log shared;
    wd_shared_log_init(&shared, &taker.own);
    wd_jobs_run(4, 64, log_once, &shared);
    wd_shared_log_finish(&shared);
    wd_shared_log_finish(&shared);
    assert_int_equal(taker.count, 64);
    assert_int_equal(taker.overlaps, 0);
    assert_int_equal(taker.passed_on, 1);
}

static void srgb_round_trips(void **state)
{
    (void)state;
    for (int i = 0; i < 256; i++)
        assert_int_equal(wd_srgb_encode(wd_srgb_decode((uint8_t)i)), i);
    assert_int_equal(wd_srgb_encode(-1.0f), 0);
    assert_int_equal(wd_srgb_encode(7.0f), 255);
}

static void count_call(void *user, size_t index)
{
    int *calls = user;
    __atomic_fetch_add(&calls[index], 1, __ATOMIC_RELAXED);
}

static void every_index_is_worked_once(void **state)
{
    (void)state;
    static const unsigned threads[] = {0, 1, 2, 7, 16, 1000};
    for (size_t t = 0; t < sizeof threads / sizeof *threads; t++) {
        int calls[1000] = {0};
        wd_jobs_run(threads[t], 1000, count_call, calls);
        for (int i = 0; i < 1000; i++)
            assert_int_equal(calls[i], 1);
    }
    wd_jobs_run(4, 0, count_call, NULL);
}

/* Of a loop whose calls wait for one another. */
struct meeting {
    pthread_mutex_t lock;
    pthread_cond_t came;
    unsigned inside, wanted;
    bool met;
    struct timespec until; /* the wanted are waited for */
};

static void meet(void *user, size_t index)
{
    struct meeting *meeting = user;
    (void)index;
    pthread_mutex_lock(&meeting->lock);
    meeting->met |= ++meeting->inside >= meeting->wanted;
    pthread_cond_broadcast(&meeting->came);
    int waited = 0;
    while (!meeting->met && waited == 0)
        waited = pthread_cond_timedwait(&meeting->came, &meeting->lock, &meeting->until);
    meeting->inside--;
    pthread_mutex_unlock(&meeting->lock);
}

static void as_many_threads_as_asked_for_work(void **state)
{
    (void)state;
    struct meeting meeting = {.lock = PTHREAD_MUTEX_INITIALIZER,
                              .came = PTHREAD_COND_INITIALIZER,
                              .wanted = 100};
    clock_gettime(CLOCK_REALTIME, &meeting.until);
    meeting.until.tv_sec += 20;
    wd_jobs_run(100, 100, meet, &meeting);
    assert_true(meeting.met);
}

static void threads_are_as_many_as_processors(void **state)
{
    (void)state;
    cpu_set_t all, one;
    if (sched_getaffinity(0, sizeof all, &all) != 0)
        skip(); /* more processors than the set has places */
    assert_int_equal(wd_jobs_default_threads(), CPU_COUNT(&all));
    CPU_ZERO(&one);
    for (int i = 0; i < CPU_SETSIZE && CPU_COUNT(&one) == 0; i++)
        if (CPU_ISSET(i, &all))
            CPU_SET(i, &one);
    assert_int_equal(sched_setaffinity(0, sizeof one, &one), 0);
    assert_int_equal(wd_jobs_default_threads(), 1);
    assert_int_equal(sched_setaffinity(0, sizeof all, &all), 0);
}

struct told {
    uint64_t last, stop_at;
    int calls[1000];
};

static void count_told(void *user, size_t index)
{
    count_call(((struct told *)user)->calls, index);
}

static bool hear_progress(void *user, const char *stage, uint64_t done, uint64_t total)
{
    struct told *told = user;
    assert_string_equal(stage, "counting");
    assert_true(done > told->last && done <= total && total == 1000);
    told->last = done;
    return done < told->stop_at;
}

static void loops_tell_how_far_they_are(void **state)
{
    (void)state;
    for (unsigned threads = 1; threads < 5; threads++) {
        struct told all = {.stop_at = 2000}, some = {.stop_at = 10};
        const struct wd_progress to_all = {hear_progress, &all}, to_some = {hear_progress, &some};
        assert_true(wd_jobs_run_told(threads, 1000, count_told, &all, &to_all, "counting"));
        for (int i = 0; i < 1000; i++)
            assert_int_equal(all.calls[i], 1);
        assert_true(threads > 1 || all.last == 1000);
        bool whole = wd_jobs_run_told(threads, 1000, count_told, &some, &to_some, "counting");
        int calls = 0;
        for (int i = 0; i < 1000; i++)
            calls += some.calls[i];
        assert_true(whole ? calls == 1000 : some.last >= 10);
        assert_true(threads > 1 || calls == 10);
    }
}

struct heard {
    int errors;
    char last[512];
};

static void hear(void *user, enum wd_log_level level, const char *message)
{
    struct heard *heard = user;
    heard->errors += level == WD_LOG_ERROR;
    snprintf(heard->last, sizeof heard->last, "%s", message);
}

static void assert_heard(struct heard *heard, const char *text, const char *wanted)
{
    const struct wd_log log = {hear, heard};
    wd_error(&log, "%s", text);
    assert_string_equal(heard->last, wanted);
}

/* Whatever is in a file or its name: a message is one line of UTF-8. */
static void names_without_accents(void **state)
{
    (void)state;
    static const char name[] = "H\xc3\x96he Ho\xcc\x88he\xc2\xa0" "DIAM\xc3\x88TRE\tN\xc2\xb0 \xc3\x97 \xff";
    char plain[64];
    wd_utf8_plain(plain, sizeof plain, name, sizeof name - 1);
    assert_string_equal(plain, "hohe hohe diametre n\xc2\xb0 \xc3\x97 \xff");
    wd_utf8_plain(plain, 4, name, sizeof name - 1);
    assert_string_equal(plain, "hoh");
}

static void messages_are_one_line_of_utf8(void **state)
{
    (void)state;
    struct heard heard = {0};
    assert_heard(&heard, "a\nb\tc\rd\x1b[31m\x7f", "a\\nb\\tc\\rd\\x1b[31m\\x7f");
    assert_heard(&heard, "H\xc3\xb6he \xe2\x82\xac \xf0\x9f\x8c\xb2", "H\xc3\xb6he \xe2\x82\xac \xf0\x9f\x8c\xb2");
    assert_heard(&heard, "H\xf6he \xc3", "H\\xf6he \\xc3");
    assert_heard(&heard, "\xc0\xaf \xed\xa0\x80 \xf4\x90\x80\x80", /* too long, half a pair, too far */
                 "\\xc0\\xaf \\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80");
    char line[8];
    wd_utf8_line(line, sizeof line, "12345\xc3\xb6\xc3\xb6");
    assert_string_equal(line, "12345\xc3\xb6");
    wd_utf8_line(line, sizeof line, "12345\n\n");
    assert_string_equal(line, "12345\\n");
}

static void an_output_appears_whole_or_not_at_all(void **state)
{
    (void)state;
    char directory[] = "/tmp/weald-test-XXXXXX";
    assert_non_null(mkdtemp(directory));
    char *path = wd_format("%s/out.txt", directory);
    struct wd_output_file file;
    assert_true(wd_output_open(&file, path, NULL));
    fputs("half", file.stream);
    wd_output_discard(&file);
    assert_false(wd_file_exists(path));
    assert_true(wd_output_open(&file, path, NULL));
    fputs("whole", file.stream);
    assert_false(wd_file_exists(path));
    assert_true(wd_output_commit(&file, NULL));
    char *data;
    size_t size;
    assert_true(wd_file_read(path, 100, NULL, &data, &size));
    assert_string_equal(data, "whole");
    free(data);
    struct heard heard = {0};
    const struct wd_log log = {hear, &heard};
    assert_false(wd_file_read(path, 3, &log, &data, &size));
    assert_false(wd_output_open(&file, directory, &log));
    assert_int_equal(heard.errors, 2);
    assert_non_null(strstr(heard.last, directory));
    unlink(path);
    assert_int_equal(rmdir(directory), 0); /* no temporary file is left */
    free(path);
}

static void write_text(const char *path, const char *text)
{
    struct wd_output_file file;
    assert_true(wd_output_open(&file, path, NULL));
    fputs(text, file.stream);
    assert_true(wd_output_commit(&file, NULL));
}

/* Links stay and lead to what was written, also to what was not there; permissions stay. */
static void outputs_go_where_links_lead(void **state)
{
    (void)state;
    char directory[] = "/tmp/weald-test-XXXXXX";
    assert_non_null(mkdtemp(directory));
    char *sub = wd_format("%s/sub", directory), *path = wd_format("%s/out.txt", directory);
    char *link = wd_format("%s/link.txt", sub), *loop = wd_format("%s/loop.txt", sub);
    struct stat info;
    struct heard heard = {0};
    const struct wd_log log = {hear, &heard};
    struct wd_output_file file;
    assert_int_equal(mkdir(sub, 0777) | symlink("../out.txt", link) | symlink("loop.txt", loop), 0);
    write_text(link, "new");
    assert_int_equal(chmod(path, 0640), 0);
    write_text(link, "newer");
    assert_true(lstat(link, &info) == 0 && S_ISLNK(info.st_mode));
    assert_true(lstat(path, &info) == 0 && S_ISREG(info.st_mode) && info.st_size == 5);
    assert_int_equal(info.st_mode & 0777, 0640);
    assert_false(wd_output_open(&file, loop, &log));
    assert_non_null(strstr(heard.last, "loop.txt: cannot be written: Too many levels"));
    assert_int_equal(unlink(loop) | mkfifo(loop, 0666), 0);
    assert_false(wd_output_open(&file, loop, &log));
    assert_non_null(strstr(heard.last, "loop.txt: is a device, pipe or socket"));
    assert_int_equal(unlink(loop) | unlink(link) | unlink(path) | rmdir(sub) | rmdir(directory), 0);
    free(sub);
    free(path);
    free(link);
    free(loop);
}

/* Root may write whatever the permissions say: a child of the test is somebody else. */
static void files_that_may_not_be_written_stay(void **state)
{
    (void)state;
    char directory[] = "/tmp/weald-test-XXXXXX";
    assert_non_null(mkdtemp(directory));
    char *path = wd_format("%s/out.txt", directory);
    struct stat info;
    write_text(path, "old");
    assert_int_equal(chmod(directory, 0777) | chmod(path, 0444), 0);
    pid_t child = fork();
    if (child == 0) {
        struct heard heard = {0};
        const struct wd_log log = {hear, &heard};
        struct wd_output_file file;
        if (geteuid() == 0 && setuid(65534) != 0)
            _exit(0);
        _exit(wd_output_open(&file, path, &log) || !strstr(heard.last, "out.txt: cannot be written: Permission denied"));
    }
    int status = -1;
    waitpid(child, &status, 0);
    assert_int_equal(status, 0);
    assert_true(stat(path, &info) == 0 && info.st_size == 3 && (info.st_mode & 0777) == 0444);
    assert_int_equal(unlink(path) | rmdir(directory), 0);
    free(path);
}

static void *write_again(void *path)
{
    struct wd_output_file file;
    assert_true(wd_output_open(&file, path, NULL));
    fputs("again", file.stream);
    assert_true(wd_output_commit(&file, NULL));
    return NULL;
}

static void threads_may_write_one_output(void **state)
{
    (void)state;
    char directory[] = "/tmp/weald-test-XXXXXX";
    assert_non_null(mkdtemp(directory));
    char *path = wd_format("%s/out.txt", directory);
    struct wd_output_file file;
    pthread_t thread;
    assert_true(wd_output_open(&file, path, NULL));
    fputs("once", file.stream);
    assert_int_equal(pthread_create(&thread, NULL, write_again, path), 0);
    pthread_join(thread, NULL);
    assert_true(wd_output_commit(&file, NULL));
    unlink(path);
    assert_int_equal(rmdir(directory), 0);
    free(path);
}

/* As processes name them that are no more, with their thread and, once, without. */
static void what_killed_writers_leave_is_swept(void **state)
{
    (void)state;
    char directory[] = "/tmp/weald-test-XXXXXX";
    assert_non_null(mkdtemp(directory));
    char *path = wd_format("%s/out.txt", directory), *own = wd_temporary_name(path);
    char *left[] = {wd_format("%s/.2147483646.2147483647-out.txt", directory),
                    wd_format("%s/.2147483646-out.txt", directory),
                    wd_format("%s/.2147483646.1-other.txt", directory), own};
    for (int i = 0; i < 4; i++)
        fclose(fopen(left[i], "w"));
    wd_output_sweep(path);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(wd_file_exists(left[i]), i >= 2);
        unlink(left[i]);
        free(left[i]);
    }
    assert_int_equal(rmdir(directory), 0);
    free(path);
}

static void a_full_disk_leaves_nothing(void **state)
{
    (void)state;
    struct heard heard = {0};
    const struct wd_log log = {hear, &heard};
    struct wd_output_file file;
    if (access("/dev/full", W_OK) != 0)
        skip();
    char directory[] = "/tmp/weald-test-XXXXXX";
    assert_non_null(mkdtemp(directory));
    char *path = wd_format("%s/out.txt", directory);
    assert_true(wd_output_open(&file, path, &log));
    assert_non_null(freopen("/dev/full", "wb", file.stream));
    fputs("this does not fit", file.stream);
    assert_false(wd_output_commit(&file, &log));
    assert_int_equal(heard.errors, 1);
    assert_non_null(strstr(heard.last, "No space left"));
    assert_int_equal(rmdir(directory), 0);
    free(path);
}

static void names_are_seen_from_their_file(void **state)
{
    (void)state;
    static const char *const cases[][3] = {
        {"scenes/a.json", "b.csv", "scenes/b.csv"},
        {"a.json", "b.csv", "b.csv"},
        {"/x/a.json", "../b.csv", "/x/../b.csv"},
        {"scenes/a.json", "/b.csv", "/b.csv"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char *path = wd_path_beside(cases[i][0], cases[i][1]);
        assert_string_equal(path, cases[i][2]);
        free(path);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elementary_functions_are_accurate),
        cmocka_unit_test(numbers_have_points),
        cmocka_unit_test(threads_log_one_at_a_time),
        cmocka_unit_test(messages_are_one_line_of_utf8),
        cmocka_unit_test(names_without_accents),
        cmocka_unit_test(srgb_round_trips),
        cmocka_unit_test(every_index_is_worked_once),
        cmocka_unit_test(as_many_threads_as_asked_for_work),
        cmocka_unit_test(threads_are_as_many_as_processors),
        cmocka_unit_test(loops_tell_how_far_they_are),
        cmocka_unit_test(an_output_appears_whole_or_not_at_all),
        cmocka_unit_test(outputs_go_where_links_lead),
        cmocka_unit_test(files_that_may_not_be_written_stay),
        cmocka_unit_test(threads_may_write_one_output),
        cmocka_unit_test(what_killed_writers_leave_is_swept),
        cmocka_unit_test(a_full_disk_leaves_nothing),
        cmocka_unit_test(names_are_seen_from_their_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
