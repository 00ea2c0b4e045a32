/* Makes the k-th call that changes a file end the process, or fail: loaded before the C library (LD_PRELOAD).
 *
 * PLATEAU_FAULT is MODE:K. The mode `kill` ends the process before call K, `half` in the midst of it, at the end of a page;
 * `once` lets call K fail as on a full disc, `full` that call and all after it. K = 0: none. At the end of the process
 * PLATEAU_FAULT_COUNT, if set, names a file that takes the number of calls.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Bytes of a page of memory, in which the system takes what is written. */
#define PAGE 4096

static atomic_long calls;

#define REAL(name) ((__typeof__(name) *)dlsym(RTLD_NEXT, #name))

static char mode(long *k) {
    const char *fault = getenv("PLATEAU_FAULT");
    const char *colon = fault ? strchr(fault, ':') : NULL;
    *k = colon ? atol(colon + 1) : 0;
    return fault ? fault[0] : '-';
}

/* Whether this call is to fail; does not return where it is to kill. `half` writes a part of the bytes. */
static int fails(void (*half)(void *), void *what) {
    long k, call = atomic_fetch_add(&calls, 1) + 1;
    char how = mode(&k);
    if (k == 0 || call < k || (call > k && how != 'f'))
        return 0;
    if (how == 'h' && half)
        half(what);
    if (how == 'k' || how == 'h')
        kill(getpid(), SIGKILL);
    errno = ENOSPC;
    return 1;
}

/* Standard streams, pipes and the like are no files that anybody keeps. */
static int is_kept(int file) {
    struct stat status;
    return file > 2 && fstat(file, &status) == 0 && S_ISREG(status.st_mode);
}

struct bytes {
    int file;
    const void *from;
    size_t count;
    off_t at;
};

static void half_written(void *what) {
    struct bytes *bytes = what;
    off_t start = bytes->at < 0 ? lseek(bytes->file, 0, SEEK_CUR) : bytes->at;
    off_t middle = (start + (off_t)bytes->count / 2 + PAGE / 2) / PAGE * PAGE;
    if (middle <= start || middle >= start + (off_t)bytes->count)
        return;
    if (bytes->at < 0)
        REAL(write)(bytes->file, bytes->from, middle - start);
    else
        REAL(pwrite)(bytes->file, bytes->from, middle - start, bytes->at);
}

ssize_t write(int file, const void *from, size_t count) {
    struct bytes bytes = {file, from, count, -1};
    return is_kept(file) && fails(half_written, &bytes) ? -1 : REAL(write)(file, from, count);
}

ssize_t pwrite(int file, const void *from, size_t count, off_t at) {
    struct bytes bytes = {file, from, count, at};
    return is_kept(file) && fails(half_written, &bytes) ? -1 : REAL(pwrite)(file, from, count, at);
}

ssize_t pwrite64(int file, const void *from, size_t count, off64_t at) {
    return pwrite(file, from, count, at);
}

ssize_t copy_file_range(int from, off64_t *from_at, int to, off64_t *to_at, size_t count, unsigned int flags) {
    return fails(NULL, NULL) ? -1 : REAL(copy_file_range)(from, from_at, to, to_at, count, flags);
}

int ftruncate(int file, off_t length) {
    return fails(NULL, NULL) ? -1 : REAL(ftruncate)(file, length);
}

int ftruncate64(int file, off64_t length) {
    return ftruncate(file, length);
}

int fsync(int file) {
    return fails(NULL, NULL) ? -1 : REAL(fsync)(file);
}

int rename(const char *old, const char *new) {
    return fails(NULL, NULL) ? -1 : REAL(rename)(old, new);
}

int link(const char *old, const char *new) {
    return fails(NULL, NULL) ? -1 : REAL(link)(old, new);
}

int linkat(int from, const char *old, int to, const char *new, int flags) {
    return fails(NULL, NULL) ? -1 : REAL(linkat)(from, old, to, new, flags);
}

/* Removing a file needs no room: it may be the last call, but does not fail. */
int unlink(const char *path) {
    fails(NULL, NULL);
    return REAL(unlink)(path);
}

/* Opening counts where it may make a file. */
static int opened(const char *path, int flags, mode_t permissions) {
    if ((flags & O_CREAT) && fails(NULL, NULL))
        return -1;
    return REAL(open)(path, flags, permissions);
}

int open(const char *path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    mode_t permissions = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return opened(path, flags, permissions);
}

int open64(const char *path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    mode_t permissions = flags & O_CREAT ? va_arg(rest, mode_t) : 0;
    va_end(rest);
    return opened(path, flags, permissions);
}

/* PLATEAU_THREADS, if set, is how many threads there are to be had. */
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument) {
    static atomic_long made;
    const char *most = getenv("PLATEAU_THREADS");
    if (most && atomic_fetch_add(&made, 1) >= atol(most))
        return EAGAIN;
    return REAL(pthread_create)(thread, attributes, start, argument);
}

__attribute__((destructor)) static void tell(void) {
    const char *path = getenv("PLATEAU_FAULT_COUNT");
    int file = path ? REAL(open)(path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    if (file >= 0) {
        dprintf(file, "%ld", atomic_load(&calls));
        close(file);
    }
}
