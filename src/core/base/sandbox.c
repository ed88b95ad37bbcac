// sandbox.c - seccomp (Linux 3.5), Landlock (Linux 5.13) and limits of resources
#include "core/base/sandbox.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

// ---------------------------------------------------------------- Landlock: files

// No file has a name any more. Kernels without Landlock are left to seccomp, which lets nothing be
// opened for writing.
static void hide_files(void)
{
    const struct landlock_ruleset_attr all = {
        .handled_access_fs = LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                             LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR |
                             LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                             LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG |
                             LANDLOCK_ACCESS_FS_MAKE_SYM};
    const int rules = (int)syscall(SYS_landlock_create_ruleset, &all, sizeof all, 0);
    if (rules < 0)
        return;
    (void)syscall(SYS_landlock_restrict_self, rules, 0);
    close(rules);
}

// ---------------------------------------------------------------- seccomp: calls

#if defined __x86_64__
#define OWN_ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined __aarch64__
#define OWN_ARCHITECTURE AUDIT_ARCH_AARCH64
#endif

#ifdef OWN_ARCHITECTURE

// Whatever computing, memory, threads, time and what is open already need. Everything else fails
// with EPERM: sockets, new programs and processes, names of files, other processes, settings.
static const int allowed[] = {
    SYS_read,
    SYS_write,
    SYS_readv,
    SYS_writev,
    SYS_pread64,
    SYS_pwrite64,
    SYS_lseek,
    SYS_close,
    SYS_fstat,
    SYS_newfstatat,
    SYS_statx,
    SYS_fcntl,
    SYS_dup,
    SYS_pipe2,
    SYS_readlinkat,
    SYS_getdents64,
    SYS_faccessat,
    SYS_sendmsg,
    SYS_recvmsg,
    SYS_ppoll,
    SYS_mmap,
    SYS_munmap,
    SYS_mremap,
    SYS_mprotect,
    SYS_madvise,
    SYS_brk,
    SYS_memfd_create,
    SYS_ftruncate,
    SYS_membarrier,
    SYS_futex,
    SYS_set_robust_list,
    SYS_rseq,
    SYS_sched_yield,
    SYS_sched_getaffinity,
    SYS_set_tid_address,
    SYS_getpid,
    SYS_gettid,
    SYS_exit,
    SYS_exit_group,
    SYS_rt_sigaction,
    SYS_rt_sigprocmask,
    SYS_rt_sigreturn,
    SYS_sigaltstack,
    SYS_restart_syscall,
    SYS_clock_gettime,
    SYS_clock_getres,
    SYS_clock_nanosleep,
    SYS_nanosleep,
    SYS_gettimeofday,
    SYS_getrandom,
    SYS_getrusage,
    SYS_times,
    SYS_uname,
    SYS_sysinfo,
    SYS_getcwd,
    SYS_getuid,
    SYS_geteuid,
    SYS_getgid,
    SYS_getegid,
#ifdef __x86_64__
    SYS_stat,
    SYS_lstat,
    SYS_access,
    SYS_readlink,
    SYS_poll,
    SYS_pipe,
    SYS_dup2,
    SYS_getrlimit,
    SYS_setrlimit,
    SYS_time,
    SYS_arch_prctl,
    SYS_getdents,
#endif
};
enum { ALLOWED = sizeof allowed / sizeof *allowed };

// These depend on an argument: new threads, not new processes (clone3 hides its flags: libraries go
// back to clone); opening for reading; signals to this process and limits of it.
enum { CLONE_FLAGS = 0, OPENAT_FLAGS = 2, OPEN_FLAGS = 1, TGKILL_PROCESS = 0, PRLIMIT_PROCESS = 0 };

#define AT(field)            offsetof(struct seccomp_data, field)
#define LOAD(offset)         BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (offset))
#define IF_EQUAL(k, yes, no) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (k), (yes), (no))
#define IF_ANY(k, yes, no)   BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, (k), (yes), (no))
#define END(what)            BPF_STMT(BPF_RET | BPF_K, (what))
#define REFUSE(error)        END(SECCOMP_RET_ERRNO | (error))
#define ALLOW                END(SECCOMP_RET_ALLOW)
// An argument's lower half comes first: both architectures are little endian.
// The test goes on where the call is allowed, and over that where it is not.
#define WHEN(call, argument, test)                                                                 \
    IF_EQUAL(call, 0, 4), LOAD(AT(args) + 8 * (argument)), test, ALLOW, REFUSE(EPERM)

static void filter_calls(void)
{
    const unsigned own = (unsigned)getpid();
    static const unsigned writing = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
    const struct sock_filter head[] = {
        LOAD(AT(arch)),
        IF_EQUAL(OWN_ARCHITECTURE, 1, 0),
        END(SECCOMP_RET_KILL_PROCESS),
        LOAD(AT(nr)),
        IF_EQUAL(SYS_clone3, 0, 1),
        REFUSE(ENOSYS),
        WHEN(SYS_clone, CLONE_FLAGS, IF_ANY(CLONE_THREAD, 0, 1)),
        WHEN(SYS_openat, OPENAT_FLAGS, IF_ANY(writing, 1, 0)),
        WHEN(SYS_tgkill, TGKILL_PROCESS, IF_EQUAL(own, 0, 1)),
        WHEN(SYS_prlimit64, PRLIMIT_PROCESS, IF_EQUAL(0, 0, 1)),
#ifdef __x86_64__
        WHEN(SYS_open, OPEN_FLAGS, IF_ANY(writing, 1, 0)),
#endif
    };
    enum { HEAD = sizeof head / sizeof *head };
    struct sock_filter all[HEAD + 2 * ALLOWED + 1];
    memcpy(all, head, sizeof head);
    for (size_t i = 0; i < ALLOWED; i++) {
        all[HEAD + 2 * i] = (struct sock_filter)IF_EQUAL((unsigned)allowed[i], 0, 1);
        all[HEAD + 2 * i + 1] = (struct sock_filter)ALLOW;
    }
    all[HEAD + 2 * ALLOWED] = (struct sock_filter)REFUSE(EPERM);
    const struct sock_fprog program = {HEAD + 2 * ALLOWED + 1, all};
    (void)prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

#else

static void filter_calls(void)
{
}

#endif

void sandbox_close(void)
{
    static bool closed;
    if (closed)
        return;
    closed = true;
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0))
        return;
    hide_files();
    filter_calls();
}

// ---------------------------------------------------------------- resources

// False where there is less.
static bool limit(int which, uint64_t most)
{
    struct rlimit l;
    if (getrlimit((__rlimit_resource_t)which, &l))
        return true;
    l.rlim_cur = l.rlim_max == RLIM_INFINITY || most < l.rlim_max ? most : l.rlim_max;
    (void)!setrlimit((__rlimit_resource_t)which, &l);
    return l.rlim_cur == most;
}

// Sanitizers take terabytes of addresses, and none of memory.
bool sandbox_memory(uint64_t bytes)
{
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
    static uint64_t start;
    if (!start) {
        unsigned long pages = 0;
        FILE *f = fopen("/proc/self/statm", "re");
        if (!f || fscanf(f, "%lu", &pages) != 1)
            pages = 0;
        if (f)
            fclose(f);
        start = (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
    }
    return limit(RLIMIT_AS, start + bytes);
#else
    (void)bytes;
    return true;
#endif
}

double sandbox_time_used(void)
{
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    return (double)(used.ru_utime.tv_sec + used.ru_stime.tv_sec) +
           1e-6 * (double)(used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

// At the softer limit comes a signal that the caller can recognise, at the hard one merely the end.
void sandbox_time(double seconds)
{
    struct rlimit l;
    uint64_t most = 1 + (uint64_t)(sandbox_time_used() + seconds);
    if (!getrlimit(RLIMIT_CPU, &l) && l.rlim_max != RLIM_INFINITY && most >= l.rlim_max &&
        l.rlim_max > 1)
        most = l.rlim_max - 1;
    (void)limit(RLIMIT_CPU, most);
}
