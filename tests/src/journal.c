/* Keeps a journal of every call that changes a file or a folder, with what is written: loaded before the C library (LD_PRELOAD).
 *
 * PLATEAU_JOURNAL names the journal. A record is a line of words, then the bytes of names or of what is written:
 *
 *   create INODE LENGTH             a new file of that inode; its name follows
 *   write INODE OFFSET LENGTH       bytes follow
 *   truncate INODE SIZE
 *   sync INODE LENGTH               all of a file or of a folder has come to the disk; its name follows
 *   rename LENGTH LENGTH            two names follow, the old one and the new one
 *   link LENGTH LENGTH              the same
 *   unlink LENGTH                   a name follows
 *   folder LENGTH                   a name follows, of a new folder
 *
 * PLATEAU_BOOT names a file that is read in place of the one in which the system tells which start of the machine this is.
 *
 * Names are absolute. A call and its record are one step under a lock, so that records stand in the order of the calls.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define REAL(name) ((__typeof__(name) *)dlsym(RTLD_NEXT, #name))

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static int journal = -1;

/* A journal that cannot be written would be believed to be whole. */
static void put(const void *from, size_t count) {
    if (REAL(write)(journal, from, count) != (ssize_t)count)
        abort();
}

__attribute__((format(printf, 1, 2))) static void record(const char *format, ...) {
    char line[128];
    va_list rest;
    va_start(rest, format);
    put(line, vsnprintf(line, sizeof line, format, rest));
    va_end(rest);
}

__attribute__((constructor)) static void begin(void) {
    const char *path = getenv("PLATEAU_JOURNAL");
    journal = path ? REAL(open)(path, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666) : -1;
}

static char *absolute(const char *path, char *name) {
    if (path[0] == '/' || !getcwd(name, PATH_MAX))
        return strcpy(name, path);
    return strcat(strcat(name, "/"), path);
}

/* The inode of a regular file or a folder that somebody keeps; 0 of everything else. */
static long inode_of(int file) {
    struct stat status;
    int is_kept = journal >= 0 && file > 2 && fstat(file, &status) == 0 && (S_ISREG(status.st_mode) || S_ISDIR(status.st_mode));
    return is_kept ? (long)status.st_ino : 0;
}

static void one_name(const char *what, const char *path) {
    char name[PATH_MAX];
    if (journal < 0)
        return;
    absolute(path, name);
    record("%s %zu\n", what, strlen(name));
    put(name, strlen(name));
}

static void two_names(const char *what, const char *old, const char *new) {
    char first[PATH_MAX], second[PATH_MAX];
    if (journal < 0)
        return;
    absolute(old, first);
    absolute(new, second);
    record("%s %zu %zu\n", what, strlen(first), strlen(second));
    put(first, strlen(first));
    put(second, strlen(second));
}

static void bytes(long inode, off_t at, const void *from, ssize_t count) {
    if (inode == 0 || count <= 0)
        return;
    record("write %ld %ld %zd\n", inode, (long)at, count);
    put(from, count);
}

/* The same call, and its record unless it failed. */
#define STEP(type, call, then)                                                                                         \
    pthread_mutex_lock(&lock);                                                                                         \
    type result = call;                                                                                                \
    int error = errno;                                                                                                 \
    if (result >= 0) {                                                                                                 \
        then;                                                                                                          \
    }                                                                                                                  \
    pthread_mutex_unlock(&lock);                                                                                       \
    errno = error;                                                                                                     \
    return result

ssize_t write(int file, const void *from, size_t count) {
    STEP(ssize_t, REAL(write)(file, from, count), bytes(inode_of(file), lseek(file, 0, SEEK_CUR) - result, from, result));
}

ssize_t pwrite(int file, const void *from, size_t count, off_t at) {
    STEP(ssize_t, REAL(pwrite)(file, from, count, at), bytes(inode_of(file), at, from, result));
}

ssize_t pwrite64(int file, const void *from, size_t count, off64_t at) {
    return pwrite(file, from, count, at);
}

/* Whoever calls it has another way where the system has not this one. */
ssize_t copy_file_range(int from, off64_t *from_at, int to, off64_t *to_at, size_t count, unsigned int flags) {
    if (journal < 0)
        return REAL(copy_file_range)(from, from_at, to, to_at, count, flags);
    errno = ENOSYS;
    return -1;
}

static void cut(int file, off_t size) {
    long inode = inode_of(file);
    if (inode)
        record("truncate %ld %ld\n", inode, (long)size);
}

int ftruncate(int file, off_t size) {
    STEP(int, REAL(ftruncate)(file, size), cut(file, size));
}

int ftruncate64(int file, off64_t size) {
    return ftruncate(file, size);
}

static void came_to_disk(int file) {
    char link[64], name[PATH_MAX];
    long inode = inode_of(file);
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, name, sizeof name);
    if (inode == 0 || length < 0)
        return;
    record("sync %ld %zd\n", inode, length);
    put(name, length);
}

int fsync(int file) {
    STEP(int, REAL(fsync)(file), came_to_disk(file));
}

int fdatasync(int file) {
    STEP(int, REAL(fdatasync)(file), came_to_disk(file));
}

int rename(const char *old, const char *new) {
    STEP(int, REAL(rename)(old, new), two_names("rename", old, new));
}

int link(const char *old, const char *new) {
    STEP(int, REAL(link)(old, new), two_names("link", old, new));
}

/* Paths are those of the working folder: the program names no other one by a handle. */
int linkat(int from, const char *old, int to, const char *new, int flags) {
    STEP(int, REAL(linkat)(from, old, to, new, flags), two_names("link", old, new));
}

int unlink(const char *path) {
    STEP(int, REAL(unlink)(path), one_name("unlink", path));
}

int mkdir(const char *path, mode_t permissions) {
    STEP(int, REAL(mkdir)(path, permissions), one_name("folder", path));
}

static void made(int file, const char *path, int flags, int existed) {
    char name[PATH_MAX];
    long inode = inode_of(file);
    if (inode == 0)
        return;
    if (!existed) {
        absolute(path, name);
        record("create %ld %zu\n", inode, strlen(name));
        put(name, strlen(name));
    } else if (flags & O_TRUNC) {
        cut(file, 0);
    }
}

static int opened(const char *path, int flags, mode_t permissions) {
    const char *boot = getenv("PLATEAU_BOOT");
    if (boot && strcmp(path, "/proc/sys/kernel/random/boot_id") == 0)
        path = boot;
    if (!(flags & (O_CREAT | O_TRUNC)))
        return REAL(open)(path, flags, permissions);
    int existed;
    STEP(int, (existed = access(path, F_OK) == 0, REAL(open)(path, flags, permissions)), made(result, path, flags, existed));
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
