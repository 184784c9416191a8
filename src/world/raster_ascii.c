/* raster_ascii.c: whether an ESRI ASCII grid holds what its header says. GDAL takes words for 0 and does not look
 * beyond the cells that it wants. */
#include <ctype.h>
#include <string.h>
#include <strings.h>

#include "base/log.h"
#include "world/raster_source.h"

/* Words of the text, one by one. */
struct words {
    VSILFILE *file;
    char block[1 << 16];
    size_t size, at;
    uint64_t line;
    char word[32]; /* its beginning, where it is longer */
};

static int next_byte(struct words *words)
{
    if (words->at == words->size) {
        words->size = VSIFReadL(words->block, 1, sizeof words->block, words->file);
        words->at = 0;
    }
    return words->size ? (unsigned char)words->block[words->at++] : -1;
}

static bool next_word(struct words *words)
{
    size_t length = 0;
    int byte = next_byte(words);
    for (; byte >= 0 && isspace(byte); byte = next_byte(words))
        words->line += byte == '\n';
    for (; byte >= 0 && !isspace(byte); byte = next_byte(words))
        if (length < sizeof words->word - 1)
            words->word[length++] = (char)byte;
    if (byte >= 0)
        words->at--; /* the line's end may be it */
    words->word[length] = '\0';
    return length > 0;
}

static bool is_key(const char *word)
{
    static const char *const keys[] = {"ncols",     "nrows",    "xllcorner", "xllcenter", "yllcorner",
                                       "yllcenter", "cellsize", "dx",        "dy",        "nodata_value"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (strcasecmp(word, keys[i]) == 0)
            return true;
    return false;
}

/* Commas may stand for points. */
static bool is_number(const char *word)
{
    return strspn(word, "0123456789.,+-eE") == strlen(word) && strpbrk(word, "0123456789");
}

/* Of these GDAL makes 0 in a grid that it takes for one of whole numbers. */
static bool is_no_finite_number(const char *word)
{
    return strcasestr(word, "nan") || strcasestr(word, "inf");
}

static bool is_of_whole_numbers(const struct wd_raster_source *source)
{
    GDALDataType type = GDALGetRasterDataType(GDALGetRasterBand(source->dataset, 1));
    return type != GDT_Float32 && type != GDT_Float64;
}

static bool check_cells(struct words *words, const struct wd_raster_source *source, const struct wd_log *log)
{
    uint64_t wanted = (uint64_t)source->width * (uint64_t)source->height, count = 0;
    bool there = next_word(words);
    while (there && is_key(words->word))
        there = next_word(words) && next_word(words);
    for (; there; there = next_word(words)) {
        if (is_no_finite_number(words->word) && is_of_whole_numbers(source))
            return wd_error(log, "%s:%llu: \"%s\" in a grid of whole numbers; write the number that NODATA_value "
                            "names for cells without one (add NODATA_value -9999 to the header where there is no such line)",
                            source->path, (unsigned long long)words->line, words->word);
        if (!is_number(words->word) && !is_no_finite_number(words->word))
            return wd_error(log, "%s:%llu: \"%s\" is no number; wanted is one for each of the %d x %d cells",
                            source->path, (unsigned long long)words->line, words->word, source->width,
                            source->height);
        count++;
    }
    return count == wanted ||
           wd_error(log, "%s: has %llu numbers; its header says %d x %d cells", source->path,
                    (unsigned long long)count, source->width, source->height);
}

bool wd_source_check_text(const struct wd_raster_source *source, const struct wd_log *log)
{
    GDALDriverH driver = GDALGetDatasetDriver(source->dataset);
    if (!driver || strcmp(GDALGetDriverShortName(driver), "AAIGrid") != 0)
        return true;
    struct words words = {.file = VSIFOpenL(source->path, "rb"), .line = 1};
    if (!words.file)
        return true; /* another name of GDAL's for it */
    bool ok = check_cells(&words, source, log);
    VSIFCloseL(words.file);
    return ok;
}
