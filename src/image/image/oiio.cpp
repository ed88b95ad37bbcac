// oiio.cpp - the one file that knows OpenImageIO: a module, opened by the helper for reading and by
// picture.c for writing
#include "image/image/picture.h"
#include "image/image/picture_format.h"

extern "C" {
#include "core/base/log.h"
#include "core/base/memory.h"
}

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <new>
#include <string>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

using namespace OIIO;

namespace
{

// The whole file as memory, which every format takes that takes more than names.
class mapped_file
{
  public:
    explicit mapped_file(int file)
    {
        struct stat s;
        const bool known = !::fstat(file, &s) && s.st_size > 0;
        void *map =
            known ? mmap(nullptr, size_t(s.st_size), PROT_READ, MAP_PRIVATE, file, 0) : MAP_FAILED;
        ::close(file);
        if (map == MAP_FAILED)
            throw std::bad_alloc();
        m_bytes = static_cast<const char *>(map);
        m_size = size_t(s.st_size);
    }
    ~mapped_file()
    {
        munmap(const_cast<char *>(m_bytes), m_size);
    }
    mapped_file(const mapped_file &) = delete;
    mapped_file &operator=(const mapped_file &) = delete;
    const char *bytes() const
    {
        return m_bytes;
    }
    size_t size() const
    {
        return m_size;
    }

  private:
    const char *m_bytes;
    size_t m_size;
};

struct oiio_reader : picture_reader {
    std::unique_ptr<mapped_file> file;
    std::unique_ptr<Filesystem::IOMemReader> proxy;
    int copy = -1;  // of the file, for formats that want a name
    std::unique_ptr<ImageInput> input;
    std::string name, error;
    std::vector<unsigned char> tiles;  // the row of tiles that is being read
    int tiles_row = -1;                // its first row
    int page = 0;
    TypeDesc tiles_type;
    ~oiio_reader()
    {
        input.reset();
        if (copy >= 0)
            ::close(copy);
    }
};

const ImageSpec &spec_of(const picture_reader *reader)
{
    return static_cast<const oiio_reader *>(reader)->input->spec();
}

// One line without the library's trailing newline and without "(" file ")" noise.
std::string one_line(std::string text)
{
    for (char &c : text)
        if (c == '\n' || c == '\r')
            c = ' ';
    while (!text.empty() && text.back() == ' ')
        text.pop_back();
    return text.empty() ? "unknown error" : text;
}

relume_status broken(oiio_reader *r, const std::string &what,
                     relume_status status = RELUME_EDAMAGED)
{
    r->error = one_line(what);
    return status;
}

// Some formats leave their channels without names.
void find_colour(const ImageSpec &spec, picture_info &info)
{
    std::vector<const char *> names;
    for (const std::string &name : spec.channelnames)
        names.push_back(name.c_str());
    names.resize(size_t(spec.nchannels), "");
    picture_find_colour(&info, names.data());
}

bool says_linear(const ImageSpec &spec, const std::string &format)
{
    const std::string space = spec.get_string_attribute("oiio:ColorSpace");
    return spec.format.is_floating_point() || format == "raw" ||
           Strutil::iequals(space, "linear") || Strutil::istarts_with(space, "lin_") ||
           Strutil::iequals(space, "scene_linear");
}

// "YYYY:MM:DD HH:MM:SS" (EXIF 2.3) as seconds since 1970, whatever the time zone; 0: not a date.
int64_t seconds_of(const std::string &text)
{
    int y, m, d, hour, minute, second;
    if (std::sscanf(text.c_str(), "%d:%d:%d %d:%d:%d", &y, &m, &d, &hour, &minute, &second) != 6 ||
        y < 1900 || m < 1 || m > 12)
        return 0;
    std::tm t = {};
    t.tm_year = y - 1900;
    t.tm_mon = m - 1;
    t.tm_mday = d;
    t.tm_hour = hour;
    t.tm_min = minute;
    t.tm_sec = second;
    return int64_t(timegm(&t));
}

double positive(const ImageSpec &spec, const char *name)
{
    const float v = spec.get_float_attribute(name, 0.0f);
    return v > 0.0f && v < 1e9f ? double(v) : 0.0;
}

double shutter_of(const ImageSpec &spec)
{
    const double time = positive(spec, "ExposureTime");
    const ParamValue *apex = spec.find_attribute("Exif:ShutterSpeedValue");
    return time > 0.0 ? time : apex ? std::exp2(-double(apex->get_float())) : 0.0;
}

// A copy of the file under a name that needs no right to open files; "" when memory is short.
std::string name_copy(oiio_reader *r)
{
    if (r->copy < 0) {
        r->copy = memfd_create("relume", MFD_CLOEXEC);
        for (size_t at = 0; r->copy >= 0 && at < r->file->size();) {
            const ssize_t n = ::write(r->copy, r->file->bytes() + at, r->file->size() - at);
            if (n <= 0)
                return "";
            at += size_t(n);
        }
    }
    return r->copy < 0 ? "" : "/proc/self/fd/" + std::to_string(r->copy);
}

bool try_format(oiio_reader *r, const std::string &format, const ImageSpec &hints)
{
    auto input = ImageInput::create(format);
    ImageSpec spec;
    if (!input)
        return false;
    r->proxy.reset(new Filesystem::IOMemReader(r->file->bytes(), r->file->size()));
    const bool proxy = input->supports("ioproxy") && input->set_ioproxy(r->proxy.get());
    const std::string name = proxy ? r->name : name_copy(r);
    if (name.empty() || !input->open(name, spec, hints)) {
        r->error = Strutil::replace(one_line(input->geterror()), name, r->name);
        return false;
    }
    r->input = std::move(input);
    return true;
}

// By the ending, then whatever fits.
bool try_all(oiio_reader *r, const ImageSpec &hints)
{
    std::string names;
    OIIO::getattribute("format_list", names);
    const std::string ending = Strutil::lower(Filesystem::extension(r->name, false));
    const bool made_up = ending == "null" || ending == "term";  // read whatever is there
    if (!ending.empty() && !made_up && try_format(r, ending, hints))
        return true;
    for (const std::string &name : Strutil::splits(names, ","))
        if (name != "null" && name != "term" && try_format(r, name, hints))
            return true;
    r->error = "of no format that OpenImageIO knows";
    return false;
}

// Of the page that is open.
relume_status take_spec(oiio_reader *r, const relume_limits *limits)
{
    const ImageSpec &spec = r->input->spec();
    if (spec.depth > 1 || spec.deep || spec.nchannels < 1)
        return broken(r, "expected a flat image with colour channels", RELUME_EUNSUPPORTED);
    if (!limits_allow(limits, spec.width, spec.height)) {
        const relume_limits most = limits_or_default(limits);
        return broken(r,
                      std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                          " pixels; expected 1 to " + std::to_string(most.max_side) +
                          " a side and at most " + std::to_string(most.max_pixels) +
                          " in all (--max-pixels)",
                      RELUME_ELIMIT);
    }
    r->info.width = spec.width;
    r->info.height = spec.height;
    r->info.x = spec.x;
    r->info.y = spec.y;
    r->info.channels = spec.nchannels;
    r->info.bytes = spec.format == TypeUInt8 && spec.channelformats.empty();
    r->info.floats = spec.format.is_floating_point();
    r->info.linear = says_linear(spec, r->input->format_name());
    find_colour(spec, r->info);
    return RELUME_OK;
}

relume_status open_input(oiio_reader *r, const std::string &format, const relume_limits *limits)
{
    OIIO::attribute("exr_threads", -1);  // our own threads work on many files at once
    OIIO::attribute("threads", 1);
    ImageSpec hints;
    hints["oiio:UnassociatedAlpha"] = 1;
    hints["raw:ColorSpace"] = "Linear";
    hints["raw:auto_bright"] = 0;  // exposures of a bracket keep their ratios
    hints["raw:adjust_maximum_thr"] = 0.0f;
    hints["raw:use_camera_wb"] = 1;
    const bool opened = format.empty() ? try_all(r, hints) : try_format(r, format, hints);
    const std::string why = one_line(r->error.empty() ? OIIO::geterror() : r->error);
    if (!opened && format == "raw")
        return broken(r,
                      "a RAW photograph that the installed OpenImageIO cannot read; expected a "
                      "build with LibRaw that knows this camera, or TIFF; " +
                          why,
                      RELUME_EUNSUPPORTED);
    if (!opened)
        return broken(r, "not a readable image; " + why,
                      format.empty() ? RELUME_EFORMAT : RELUME_EDAMAGED);
    return take_spec(r, limits);
}

// Row `y` lies in a row of tiles: they are read once, in the type that is asked for.
const void *row_in_tiles(oiio_reader *r, int y, TypeDesc type)
{
    const ImageSpec &spec = r->input->spec();
    const int first = y - y % spec.tile_height;
    const int end = std::min(first + spec.tile_height, spec.height);
    const size_t stride = size_t(spec.width) * size_t(spec.nchannels) * type.size();
    if (r->tiles_row != first || r->tiles_type != type) {
        r->tiles.resize(stride * size_t(spec.tile_height));
        r->tiles_row = -1;
        if (!r->input->read_tiles(r->page, 0, spec.x, spec.x + spec.width, spec.y + first,
                                  spec.y + end, spec.z, spec.z + 1, 0, spec.nchannels, type,
                                  r->tiles.data()))
            return nullptr;
        r->tiles_row = first;
        r->tiles_type = type;
    }
    return &r->tiles[stride * size_t(y - first)];
}

bool read_tiled_rows(oiio_reader *r, int row, int rows, TypeDesc type, char *out)
{
    const ImageSpec &spec = r->input->spec();
    const size_t stride = size_t(spec.width) * size_t(spec.nchannels) * type.size();
    for (int i = 0; i < rows; i++, out += stride) {
        const void *from = row_in_tiles(r, row + i, type);
        if (!from)
            return false;
        std::memcpy(out, from, stride);
    }
    return true;
}

relume_status read_rows(oiio_reader *r, int row, int rows, TypeDesc type, void *out)
{
    try {
        const ImageSpec &spec = r->input->spec();
        const int y = spec.y + row;
        const size_t stride = size_t(spec.width) * spec.nchannels * type.size();
        bool good = true;
        if (spec.tile_width)
            good = read_tiled_rows(r, row, rows, type, (char *)out);
        else if (type == spec.format && spec.channelformats.empty())
            good = r->input->read_native_scanlines(r->page, 0, y, y + rows, spec.z, out);
        else  // one by one: the call for many rows sets aside 64 MB at every call
            for (int i = 0; good && i < rows; i++)
                good = r->input->read_scanline(y + i, spec.z, type, (char *)out + i * stride);
        if (good && !r->input->has_error())
            return RELUME_OK;
        return broken(r, "truncated or damaged; " + one_line(r->input->geterror()));
    } catch (const std::bad_alloc &) {
        return RELUME_ENOMEM;
    } catch (const std::exception &e) {
        return broken(r, std::string("damaged; ") + e.what());
    }
}

std::unique_ptr<ImageOutput> writer_for(const char *path)
{
    auto output = ImageOutput::create(path);
    if (!output)
        (void)OIIO::geterror();
    return output;
}

// Through memory where the format can, so that a full disk is noticed by our own writes.
relume_status write_in_memory(ImageOutput &output, const char *path, const relume_writer *writer,
                              const ImageSpec &spec, TypeDesc type, const void *samples,
                              picture_save *save, const relume_log *log)
{
    std::vector<unsigned char> bytes;
    Filesystem::IOVecOutput proxy(bytes);
    output.set_ioproxy(&proxy);
    if (!output.open(path, spec) || !output.write_image(type, samples) || !output.close())
        return log_fail(log, RELUME_EIO, "%s: cannot be written; %s", path,
                        one_line(output.geterror()).c_str());
    return save(path, writer, bytes.data(), bytes.size(), log);
}

// Elsewhere, since OpenImageIO writes names only.
relume_status write_elsewhere(ImageOutput &output, const char *path, const relume_writer *writer,
                              const ImageSpec &spec, TypeDesc type, const void *samples,
                              picture_save *save, const relume_log *log)
{
    relume_making *folder;
    const relume_status status =
        relume_making_open(&folder, nullptr, RELUME_MADE_FOLDER, false, log);
    if (status)
        return status;
    const std::string name =
        std::string(relume_making_path(folder)) + "/picture" + Filesystem::extension(path);
    bool good = output.open(name, spec) && output.write_image(type, samples) && output.close();
    std::string why = good ? "" : one_line(output.geterror());
    std::string bytes;
    if (good) {  // read it back: a full disk is not always reported
        std::vector<float> row(size_t(spec.width) * spec.nchannels);
        auto check = ImageInput::open(name);
        good = check && check->read_scanlines(0, 0, spec.height - 1, spec.height, 0, 0,
                                              spec.nchannels, TypeFloat, row.data());
        why = good ? "" : "incomplete; no space left?";
        check.reset();
        good = good && Filesystem::read_text_file(name, bytes);
    }
    relume_making_abort(&folder);
    if (!good)
        return log_fail(log, RELUME_EIO, "%s: cannot be written; %s", path, why.c_str());
    return save(path, writer, bytes.data(), bytes.size(), log);
}

relume_status write_image(const char *path, const relume_writer *writer, int width, int height,
                          int channels, TypeDesc type, const void *samples,
                          const picture_codes *codes, picture_save *save, const relume_log *log)
{
    try {
        auto output = writer_for(path);
        if (!output)
            return log_fail(
                log, RELUME_EINVAL,
                "%s: unknown image extension; expected .exr, .png, .jpg, .tif, .hdr, ...", path);
        // OpenImageIO 2.4 frees memory that it never set when its WebP writer refuses a picture.
        const int longest = 16383;  // libwebp's WEBP_MAX_DIMENSION
        if (std::string(output->format_name()) == "webp" &&
            (channels < 3 || width > longest || height > longest))
            return log_fail(log, RELUME_EINVAL,
                            "%s: WebP holds pictures in colour of at most %d pixels a side; "
                            "expected .png, .jpg or .tif",
                            path, longest);
        ImageSpec spec(width, height, channels, type);
        spec["CompressionQuality"] = 95;
        spec["jpeg:subsampling"] = "4:4:4";  // colour edges of paintings survive
        spec["oiio:ColorSpace"] = codes && !codes->data ? "sRGB" : "Linear";
        if (codes && codes->profile)
            spec.attribute("ICCProfile", TypeDesc(TypeDesc::UINT8, int(codes->profile_size)),
                           codes->profile);
        // OpenImageIO 2.4 writes unreadable TIFF files through a memory proxy.
        const bool in_memory =
            output->supports("ioproxy") && std::string(output->format_name()) != "tiff";
        return in_memory ? write_in_memory(*output, path, writer, spec, type, samples, save, log)
                         : write_elsewhere(*output, path, writer, spec, type, samples, save, log);
    } catch (const std::bad_alloc &) {
        return RELUME_ENOMEM;
    } catch (const std::exception &e) {
        return log_fail(log, RELUME_EIO, "%s: cannot be written; %s", path, e.what());
    }
}

void notes(const picture_reader *reader, relume_exif *out)
{
    const ImageSpec &spec = spec_of(reader);
    std::string date = spec.get_string_attribute("Exif:DateTimeOriginal");
    if (date.empty())
        date = spec.get_string_attribute("DateTime");
    const double iso = positive(spec, "Exif:PhotographicSensitivity");
    out->time_s = shutter_of(spec);
    out->f_number = positive(spec, "FNumber");
    out->iso = iso > 0.0 ? iso : positive(spec, "Exif:ISOSpeedRatings");
    out->focal_mm = positive(spec, "Exif:FocalLength");
    out->focal_35mm = positive(spec, "Exif:FocalLengthIn35mmFilm");
    out->taken_s = seconds_of(date);
    const int orientation = spec.get_int_attribute("Orientation", 1);
    out->orientation = orientation >= 1 && orientation <= 8 ? orientation : 1;
    const std::string make = spec.get_string_attribute("Make");
    const std::string model = spec.get_string_attribute("Model");
    if (!make.empty() || !model.empty())
        std::snprintf(out->camera, sizeof out->camera, "%s %s", make.c_str(), model.c_str());
}

const void *profile(const picture_reader *reader, size_t *size)
{
    const ParamValue *p = spec_of(reader).find_attribute("ICCProfile");
    *size = p ? size_t(p->datasize()) : 0;
    return p ? p->data() : nullptr;
}

relume_status read_floats(picture_reader *reader, int row, int rows, float *out)
{
    return read_rows(static_cast<oiio_reader *>(reader), row, rows, TypeFloat, out);
}

relume_status read_bytes(picture_reader *reader, int row, int rows, uint8_t *out)
{
    return read_rows(static_cast<oiio_reader *>(reader), row, rows, TypeUInt8, out);
}

const char *error(const picture_reader *reader)
{
    return static_cast<const oiio_reader *>(reader)->error.c_str();
}

void close(picture_reader *reader)
{
    delete static_cast<oiio_reader *>(reader);
}

relume_status turn(picture_reader *reader, int page, const relume_limits *limits)
{
    oiio_reader *r = static_cast<oiio_reader *>(reader);
    try {
        if (page < 0 || !r->input->seek_subimage(page, 0)) {
            (void)r->input->geterror();
            return broken(r, "no such page", RELUME_ENOTFOUND);
        }
        r->page = page;
        r->tiles_row = -1;
        return take_spec(r, limits);
    } catch (const std::bad_alloc &) {
        return RELUME_ENOMEM;
    } catch (const std::exception &e) {
        return broken(r, std::string("damaged; ") + e.what());
    }
}

const picture_format format = {read_floats, read_bytes, notes, profile, error, close, turn};

relume_status bridge_open(picture_reader **out, int file, const char *format_name, const char *name,
                          const relume_limits *limits, const relume_log *log)
{
    *out = nullptr;
    try {
        std::unique_ptr<oiio_reader> r(new oiio_reader());
        r->format = &format;
        r->name = name;
        r->file.reset(new mapped_file(file));
        const relume_status status = open_input(r.get(), format_name, limits);
        if (status)
            return log_fail(log, status, "%s", r->error.c_str());
        *out = r.release();
        return RELUME_OK;
    } catch (const std::bad_alloc &) {
        return RELUME_ENOMEM;
    } catch (const std::exception &e) {
        return log_fail(log, RELUME_EDAMAGED, "not a readable image; %s", e.what());
    }
}

relume_status bridge_write_codes(const char *path, const relume_writer *writer,
                                 const picture_codes *codes, picture_save *save,
                                 const relume_log *log)
{
    const picture_array &a = codes->array;
    return write_image(path, writer, a.width, a.height, a.channels,
                       a.bytes == 2 ? TypeUInt16 : TypeUInt8, a.data, codes, save, log);
}

relume_status bridge_write_floats(const char *path, const relume_writer *writer, int width,
                                  int height, int channels, const float *samples,
                                  picture_save *save, const relume_log *log)
{
    return write_image(path, writer, width, height, channels, TypeFloat, samples, nullptr, save,
                       log);
}

}  // namespace

extern "C" RELUME_API const oiio_bridge relume_oiio_bridge;
const oiio_bridge relume_oiio_bridge = {RELUME_VERSION, bridge_open, bridge_write_codes,
                                        bridge_write_floats};
