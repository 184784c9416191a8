#include "tree/model_file.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tree/model_parts.h"

enum { MAX_CPU_S = 300 };
static const uint64_t max_file_bytes = UINT64_C(1) << 30, max_memory = UINT64_C(12) << 30;

void wd_model_layout(const struct wd_model_header *header, uint64_t offsets[7])
{
    const uint64_t sizes[7] = {
        sizeof *header,
        header->vertex_count * sizeof(struct wd_file_vertex),
        header->index_count * sizeof(uint32_t),
        header->mesh_count * sizeof(struct wd_file_mesh),
        header->material_count * sizeof(struct wd_file_material),
        header->image_count * sizeof(struct wd_file_image),
        header->byte_count,
    };
    uint64_t at = 0;
    for (int i = 0; i < 7; i++) {
        at += (sizes[i] + 15) / 16 * 16;
        offsets[i] = at;
    }
}

/* --- the process that reads -------------------------------------------------------------- */

static void set_limit(int resource, rlim_t value)
{
    struct rlimit limit;
    if (getrlimit(resource, &limit) == 0 && (limit.rlim_cur == RLIM_INFINITY ||
                                             limit.rlim_cur > value)) {
        limit.rlim_cur = value;
        setrlimit(resource, &limit);
    }
}

/* Address space in use, so that the limit leaves room above it whatever a sanitizer maps. */
static uint64_t mapped_bytes(void)
{
    unsigned long long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file) {
        if (fscanf(file, "%llu", &pages) != 1)
            pages = 0;
        fclose(file);
    }
    return pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

static _Noreturn void read_apart(const char *path, int file)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    set_limit(RLIMIT_CORE, 0);
    set_limit(RLIMIT_CPU, MAX_CPU_S);
    set_limit(RLIMIT_AS, mapped_bytes() + max_memory);
    int nowhere = open("/dev/null", O_RDWR);
    for (int fd = 0; fd < 3 && nowhere >= 0; fd++)
        dup2(nowhere, fd);
    const int fatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};
    for (size_t i = 0; i < sizeof fatal / sizeof *fatal; i++)
        signal(fatal[i], SIG_DFL);
    wd_model_parse(path, file);
    _exit(0);
}

/* --- the process that asked -------------------------------------------------------------- */

static uint32_t word_of(const uint8_t *bytes)
{
    return bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

/* A GLB file begins with its magic, its version and how long it is. Chunks follow, of JSON and of bytes, each with its
 * length before it: assimp takes memory by it before it looks at the file's. */
static bool check_glb_lengths(int file, uint64_t size, const char *path, const struct wd_log *log)
{
    enum { HEAD = 12, CHUNK_HEAD = 8, CHUNKS = 2 };
    uint8_t head[HEAD], chunk[CHUNK_HEAD];
    if (pread(file, head, HEAD, 0) != HEAD || memcmp(head, "glTF", 4) != 0)
        return true;
    if (word_of(head + 8) != size)
        return wd_error(log, "%s: is malformed: its header says %u bytes, the file has %llu", path, word_of(head + 8),
                        (unsigned long long)size);
    uint64_t at = HEAD;
    for (int i = 0; i < CHUNKS && pread(file, chunk, CHUNK_HEAD, (off_t)at) == CHUNK_HEAD; i++) {
        uint64_t begin = at + CHUNK_HEAD;
        at = begin + word_of(chunk);
        if (at > size)
            return wd_error(log, "%s: is malformed: its chunk %d says %u bytes, the file has %llu after its head", path,
                            i + 1, word_of(chunk), (unsigned long long)(size - begin));
    }
    return true;
}

static bool check_file(const char *path, const struct wd_log *log)
{
    struct stat status;
    if (stat(path, &status))
        return wd_error(log, "%s: cannot be opened: %s", path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return wd_error(log, "%s: is not a file", path);
    if ((uint64_t)status.st_size > max_file_bytes)
        return wd_error(log, "%s: has %lld MB; models of at most %llu MB are read", path,
                        (long long)status.st_size >> 20,
                        (unsigned long long)max_file_bytes >> 20);
    int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return wd_error(log, "%s: cannot be opened: %s", path, strerror(errno));
    bool ok = check_glb_lengths(file, (uint64_t)status.st_size, path, log);
    close(file);
    return ok;
}

static bool wait_for(pid_t child, const char *path, const struct wd_log *log)
{
    int status;
    while (waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            return wd_error(log, "%s: waiting for its reading failed: %s", path, strerror(errno));
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return true;
    if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
        return wd_error(log, "%s: reading it took over %d s and was stopped", path, MAX_CPU_S);
    return wd_error(log, "%s: is malformed: the model importer failed in it", path);
}

static bool in_range(const struct wd_model_file *model)
{
    for (uint32_t i = 0; i < model->mesh_count; i++) {
        const struct wd_file_mesh *mesh = &model->meshes[i];
        if (mesh->material >= model->material_count || mesh->first_index > model->index_count ||
            mesh->index_count > model->index_count - mesh->first_index ||
            mesh->index_count % 3 != 0)
            return false;
    }
    for (uint32_t i = 0; i < model->index_count; i++)
        if (model->indices[i] >= model->vertex_count)
            return false;
    return true;
}

/* What came over is checked like a file: the reading process may have been damaged by its input. */
static bool take(struct wd_model_file *model, int file, const char *path, const struct wd_log *log)
{
    struct stat status;
    uint64_t offsets[7];
    if (fstat(file, &status) || (size_t)status.st_size < sizeof(struct wd_model_header))
        return wd_error(log, "%s: is malformed: the model importer gave nothing", path);
    model->block_size = (size_t)status.st_size;
    model->block = mmap(NULL, model->block_size, PROT_READ | PROT_WRITE, MAP_PRIVATE, file, 0);
    if (model->block == MAP_FAILED) {
        model->block = NULL;
        return wd_error(log, "%s: no memory for its %zu MB", path, model->block_size >> 20);
    }
    struct wd_model_header *header = model->block;
    header->message[sizeof header->message - 1] = '\0';
    if (!header->ready)
        return wd_error(log, "%s: %s", path, header->message);
    if (header->warning_count == 1)
        wd_warn(log, "%s: %s", path, header->message);
    else if (header->warning_count > 1)
        wd_warn(log, "%s: %s (and %u more)", path, header->message, header->warning_count - 1);
    wd_model_layout(header, offsets);
    if (header->byte_count > max_file_bytes || offsets[6] > model->block_size)
        return wd_error(log, "%s: is malformed: the model importer cut it short", path);
    uint8_t *base = model->block;
    model->vertices = (void *)(base + offsets[0]);
    model->indices = (void *)(base + offsets[1]);
    model->meshes = (void *)(base + offsets[2]);
    model->materials = (void *)(base + offsets[3]);
    model->images = (void *)(base + offsets[4]);
    model->bytes = base + offsets[5];
    model->vertex_count = header->vertex_count;
    model->index_count = header->index_count;
    model->mesh_count = header->mesh_count;
    model->material_count = header->material_count;
    model->image_count = header->image_count;
    model->stray_points = header->stray_points;
    model->stray_lines = header->stray_lines;
    for (uint32_t i = 0; i < model->image_count; i++)
        if (model->images[i].offset > header->byte_count ||
            model->images[i].size > header->byte_count - model->images[i].offset)
            return wd_error(log, "%s: is malformed: an embedded image is cut short", path);
    return in_range(model) || wd_error(log, "%s: is malformed: an index is out of range", path);
}

/* Where a standard descriptor is closed a new file may get its number, which the reading process
 * gives to /dev/null. */
static int beyond_standard(int file)
{
    if (file < 0 || file > 2)
        return file;
    int moved = fcntl(file, F_DUPFD_CLOEXEC, 3), error = errno;
    close(file);
    errno = error;
    return moved;
}

bool wd_model_file_read(struct wd_model_file *model, const char *path, const struct wd_log *log)
{
    *model = (struct wd_model_file){0};
    if (!check_file(path, log))
        return false;
    int file = beyond_standard(memfd_create("weald-model", MFD_CLOEXEC));
    if (file < 0)
        return wd_error(log, "%s: no memory to read it into: %s", path, strerror(errno));
    pid_t child = fork();
    if (child == 0)
        read_apart(path, file);
    bool ok = child > 0 ? wait_for(child, path, log)
                        : wd_error(log, "%s: no process could be started to read it: %s", path,
                                   strerror(errno));
    ok = ok && take(model, file, path, log);
    close(file);
    if (!ok)
        wd_model_file_finish(model);
    return ok;
}

void wd_model_file_finish(struct wd_model_file *model)
{
    if (model->block)
        munmap(model->block, model->block_size);
    *model = (struct wd_model_file){0};
}
