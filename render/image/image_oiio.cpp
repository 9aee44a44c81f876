// image_oiio.cpp -- the module isoparm_image.so: the only file that includes OpenImageIO. Loaded when an image is first
// read or written, because linking OpenImageIO costs half a second at every start.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/thread.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "image/image_module.h"

namespace {

std::string reason(const std::string& told) {
    // OpenImageIO repeats the file's name, which is that of the temporary.
    return told.empty() ? "OpenImageIO gave no reason" : told.substr(0, told.find('\n'));
}

int guarded(IsoparmImageError* error, const auto& work) {
    try {
        work();
        return 0;
    } catch (const std::exception& e) {
        std::strncpy(error->text, e.what(), sizeof error->text - 1);
        error->text[sizeof error->text - 1] = 0;
    } catch (...) {
        std::strncpy(error->text, "unknown error", sizeof error->text);
    }
    return 1;
}

std::size_t threads_of_process() {
    std::error_code code;
    std::size_t n = 0;
    for (std::filesystem::directory_iterator at("/proc/self/task", code), end; !code && at != end; at.increment(code)) ++n;
    return n;
}

/// OpenImageIO detaches the workers it dismisses: they still take and release a lock of its pool after attribute() has returned, and
/// a fork() meanwhile would leave the child a lock that nobody releases. Hence this waits until the process has at most `threads`
/// threads; 5 seconds at most, as threads may have been started by others.
void await_end(std::size_t threads) {
    const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(5);
    while (threads_of_process() > threads && std::chrono::steady_clock::now() < last) std::this_thread::sleep_for(std::chrono::microseconds(200));
}

/// OpenImageIO hands a new number of threads on to OpenEXR only when the next EXR file is opened. Until then OpenEXR keeps its threads, and a child
/// that was forked would wait for threads that it does not have. Hence a file of one pixel, in memory.
void hand_on_exr_threads() {
    OIIO::Filesystem::IOVecOutput bytes;
    const auto out = OIIO::ImageOutput::create("openexr");
    const float pixel = 0;
    if (!out || !out->set_ioproxy(&bytes) || !out->open("threads.exr", OIIO::ImageSpec(1, 1, 1, OIIO::TypeDesc::FLOAT)) || !out->write_image(OIIO::TypeDesc::FLOAT, &pixel) || !out->close())
        (void)OIIO::geterror();
}

std::unique_ptr<OIIO::ImageInput> opened(const char* file) {
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    auto in = OIIO::ImageInput::open(file, &as_stored);
    if (!in) throw std::runtime_error(reason(OIIO::geterror()));
    return in;
}

/// By the reader of one format, whatever the name is.
std::unique_ptr<OIIO::ImageInput> opened_as(const char* file, const char* format) {
    auto in = OIIO::ImageInput::create(format);
    if (!in) throw std::runtime_error(reason(OIIO::geterror()));
    OIIO::ImageSpec as_stored, found;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    if (!in->open(file, found, as_stored)) throw std::runtime_error(reason(in->geterror()));
    return in;
}

/// Pixels of the first subimage in the given format.
std::vector<unsigned char> read_pixels(OIIO::ImageInput& in, OIIO::TypeDesc format) {
    const OIIO::ImageSpec& spec = in.spec();
    std::vector<unsigned char> data(spec.image_pixels() * spec.nchannels * format.size());
    if (!in.read_image(0, 0, 0, spec.nchannels, format, data.data()) || in.has_error())
        throw std::runtime_error(reason(in.geterror()));
    return data;
}

void check_written(const char* file, const char* type, const IsoparmImagePixels& p, const void* data, OIIO::TypeDesc format, bool lossy) {
    const auto in = opened_as(file, type);
    const auto back = read_pixels(*in, format);
    const bool same_size =
        in->spec().width == p.width && in->spec().height == p.height && in->spec().nchannels == p.channels;
    if (!same_size || (!lossy && std::memcmp(back.data(), data, back.size()) != 0))
        throw std::runtime_error("the file does not read back as it was written; is the disk full?");
}

/// The file's channels in the order of `names`: OpenImageIO sorts them.
std::vector<float> in_order(const std::vector<float>& data, const std::vector<std::string>& stored, const std::vector<std::string>& names) {
    std::vector<std::size_t> from;
    for (const std::string& name : names) {
        const auto at = std::find(stored.begin(), stored.end(), name);
        if (at == stored.end()) throw std::runtime_error("the file has no channel " + name);
        from.push_back(std::size_t(at - stored.begin()));
    }
    std::vector<float> sorted;
    sorted.reserve(data.size() / stored.size() * names.size());
    for (std::size_t first = 0; first < data.size(); first += stored.size())
        for (const std::size_t k : from) sorted.push_back(data[first + k]);
    return sorted;
}

std::vector<float> floats(OIIO::ImageInput& in) {
    const auto bytes = read_pixels(in, OIIO::TypeDesc::FLOAT);
    std::vector<float> data(bytes.size() / sizeof(float));
    std::memcpy(data.data(), bytes.data(), bytes.size());
    return data;
}

/// Colours rounded to half floats, then the layers, for each pixel.
std::vector<float> all_channels(const IsoparmImagePixels& p) {
    const std::size_t pixels = std::size_t(p.width) * p.height;
    std::vector<unsigned short> halves(pixels * p.channels);
    std::vector<float> colours(halves.size()), all;
    OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, p.data, OIIO::TypeDesc::HALF, halves.data(), int(halves.size()));
    OIIO::convert_pixel_values(OIIO::TypeDesc::HALF, halves.data(), OIIO::TypeDesc::FLOAT, colours.data(), int(halves.size()));
    all.reserve(pixels * (p.channels + p.layers));
    for (std::size_t i = 0; i < pixels; ++i) {
        all.insert(all.end(), &colours[i * p.channels], &colours[i * p.channels] + p.channels);
        all.insert(all.end(), p.layer_data + i * p.layers, p.layer_data + (i + 1) * p.layers);
    }
    return all;
}

void set_metadata(OIIO::ImageSpec& spec, const char* const* names, const char* const* values, int metadata) {
    spec.attribute("DateTime", "");  // otherwise EXR files get the time of writing
    spec.attribute("Software", "isoparm");
    for (int i = 0; i < metadata; ++i) spec.attribute(names[i], values[i]);
}

/// libjpeg ends the program when a file cannot be written: JPEG goes to memory first. It has to outlive the output.
class InMemory {
public:
    void take(OIIO::ImageOutput& out) {
        used_ = std::strcmp(out.format_name(), "jpeg") == 0 && out.supports("ioproxy");
        if (used_) out.set_ioproxy(&bytes_);
    }
    /// After the output was closed.
    void store(const char* file) const {
        if (!used_) return;
        std::ofstream to(file, std::ios::binary | std::ios::trunc);
        to.write(reinterpret_cast<const char*>(bytes_.buffer().data()), static_cast<std::streamsize>(bytes_.buffer().size()));
        if (!to.flush()) throw std::runtime_error(std::strerror(errno));
    }

private:
    OIIO::Filesystem::IOVecOutput bytes_;
    bool used_ = false;
};

void write_pixels(const char* file, const char* type, const OIIO::ImageSpec& spec, OIIO::TypeDesc format, const void* data) {
    InMemory memory;
    const auto out = OIIO::ImageOutput::create(type);
    if (!out) throw std::runtime_error(reason(OIIO::geterror()));
    memory.take(*out);
    if (!out->open(file, spec) || !out->write_image(format, data)) throw std::runtime_error(reason(out->geterror()));
    if (!out->close() || out->has_error()) throw std::runtime_error(reason(out->geterror()));
    memory.store(file);
}

void set_place(OIIO::ImageSpec& spec, const IsoparmImagePixels& p) {
    if (!p.half) return;  // of others only TIFF has it, as a place on a page
    spec.x = p.x, spec.y = p.y;
    spec.full_width = p.whole_width, spec.full_height = p.whole_height;
}

void write_layers(const char* file, const char* type, const IsoparmImagePixels& p, const char* const* names, const char* const* values, int metadata) {
    const std::vector<float> data = all_channels(p);
    OIIO::ImageSpec spec(p.width, p.height, p.channels + p.layers, OIIO::TypeDesc::FLOAT);
    spec.channelnames.resize(p.channels);  // R, G, B and perhaps A
    spec.channelnames.insert(spec.channelnames.end(), p.layer_names, p.layer_names + p.layers);
    spec.channelformats.assign(p.channels, OIIO::TypeDesc::HALF);
    spec.channelformats.resize(spec.nchannels, OIIO::TypeDesc::FLOAT);
    spec.attribute("oiio:ColorSpace", "Linear");
    set_place(spec, p);
    set_metadata(spec, names, values, metadata);
    write_pixels(file, type, spec, OIIO::TypeDesc::FLOAT, data.data());
    const auto in = opened_as(file, type);
    const bool same_size = in->spec().width == p.width && in->spec().height == p.height && in->spec().nchannels == spec.nchannels;
    if (!same_size || in_order(floats(*in), in->spec().channelnames, spec.channelnames) != data)
        throw std::runtime_error("the file does not read back as it was written; is the disk full?");
}

void write(const char* file, const char* type, const IsoparmImagePixels& p, bool lossy, const char* const* names,
           const char* const* values, int metadata) {
    if (p.layers > 0) return write_layers(file, type, p, names, values, metadata);
    const OIIO::TypeDesc format = p.half ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT8;
    const std::size_t count = std::size_t(p.width) * p.height * p.channels;
    std::vector<unsigned char> halves;
    const void* data = p.data;
    if (p.half) {
        halves.resize(count * format.size());
        OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, p.data, format, halves.data(), int(count));
        data = halves.data();
    }
    OIIO::ImageSpec spec(p.width, p.height, p.channels, format);
    spec.attribute("oiio:ColorSpace", p.half ? "Linear" : "sRGB");
    if (!p.half) spec.attribute("oiio:UnassociatedAlpha", 1);
    if (lossy) spec.attribute("Compression", "jpeg:95");
    set_place(spec, p);
    set_metadata(spec, names, values, metadata);
    write_pixels(file, type, spec, format, data);
    check_written(file, type, p, data, format, lossy);  // 2.4.7 reports success for PNG on a full disk
}

void read(const char* file, IsoparmImageSink sink, void* user) {
    const auto in = opened(file);
    std::vector<float> data = floats(*in);
    const OIIO::ImageSpec& spec = in->spec();
    int channels = spec.nchannels;
    if (channels > 4) {  // the colours among others
        std::vector<std::string> colours{"R", "G", "B"};
        if (std::count(spec.channelnames.begin(), spec.channelnames.end(), "A") > 0) colours.push_back("A");
        data = in_order(data, spec.channelnames, colours);
        channels = int(colours.size());
    }
    sink(user, spec.width, spec.height, channels, !spec.format.is_floating_point(), data.data());
}

// ---- by rows ------------------------------------------------------------------------------------------------------

/// Metadata without which the same numbers may be another picture.
constexpr const char* kSpace[] = {"oiio:ColorSpace", "oiio:Gamma", "chromaticities", "ICCProfile", "Orientation", "PixelAspectRatio", "oiio:UnassociatedAlpha"};

bool needs_double(OIIO::TypeDesc t) {
    return t == OIIO::TypeDesc::UINT32 || t == OIIO::TypeDesc::INT32 || t == OIIO::TypeDesc::DOUBLE || t == OIIO::TypeDesc::UINT64 || t == OIIO::TypeDesc::INT64;
}
bool any_exact(const OIIO::ImageSpec& s) {
    for (int c = 0; c < s.nchannels; ++c)
        if (needs_double(s.channelformat(c))) return true;
    return false;
}

template <class T>
double value_at(const unsigned char* from) {
    T x;
    std::memcpy(&x, from, sizeof x);
    return static_cast<double>(x);
}
/// One value as it is stored; 32-bit integers are not made fractions, which would hide that 3 is not 4.
double exact_value(OIIO::TypeDesc t, const unsigned char* from) {
    if (t == OIIO::TypeDesc::UINT32) return value_at<std::uint32_t>(from);
    if (t == OIIO::TypeDesc::INT32) return value_at<std::int32_t>(from);
    if (t == OIIO::TypeDesc::UINT64) return value_at<std::uint64_t>(from);
    if (t == OIIO::TypeDesc::INT64) return value_at<std::int64_t>(from);
    if (t == OIIO::TypeDesc::DOUBLE) return value_at<double>(from);
    float x = 0;
    OIIO::convert_pixel_values(t, from, OIIO::TypeDesc::FLOAT, &x, 1);
    return x;
}
void exact_rows(const OIIO::ImageSpec& s, const std::vector<unsigned char>& native, std::size_t pixels, double* to) {
    const unsigned char* from = native.data();
    for (std::size_t i = 0; i < pixels; ++i)
        for (int c = 0; c < s.nchannels; ++c) {
            const OIIO::TypeDesc t = s.channelformat(c);
            *to++ = exact_value(t, from);
            from += t.size();
        }
}

void check_read(OIIO::ImageInput& in, bool read) {
    if (!read || in.has_error()) throw std::runtime_error(reason(in.geterror()));
}
/// Tiled files are read by whole tiles, which need not end where the image does.
void read_native(OIIO::ImageInput& in, int subimage, int level, const OIIO::ImageSpec& s, int first, int rows, OIIO::TypeDesc type, void* to) {
    const int from = s.y + first;
    check_read(in, s.tile_width ? in.read_tiles(subimage, level, s.x, s.x + s.width, from, from + rows, s.z, s.z + 1, 0, s.nchannels, type, to)
                                : in.read_scanlines(subimage, level, from, from + rows, s.z, 0, s.nchannels, type, to));
}

}  // namespace

struct IsoparmImageFile {
    std::unique_ptr<OIIO::ImageInput> in;
    std::vector<std::pair<int, int>> parts;  // subimage, level
};

namespace {

void find_parts(IsoparmImageFile& f) {
    for (int s = 0; f.in->seek_subimage(s, 0); ++s)
        for (int level = 0; f.in->seek_subimage(s, level); ++level) {
            if (f.parts.size() >= 4096) throw std::runtime_error("found more than 4096 parts");
            f.parts.push_back({s, level});
        }
    (void)f.in->geterror();  // that the last one was not there
    if (f.parts.empty()) throw std::runtime_error("found no image");
}

void describe(IsoparmImageFile& f, int number, IsoparmImagePart& part, IsoparmImageFact fact, void* user) {
    const auto [subimage, level] = f.parts[number];
    const OIIO::ImageSpec s = f.in->spec(subimage, level);
    part = {s.x, s.y, s.width, s.height, s.full_x, s.full_y, s.full_width, s.full_height, s.nchannels, s.tile_height, any_exact(s), s.deep, s.depth};
    for (int c = 0; c < s.nchannels; ++c) {
        fact(user, "channel", c < int(s.channelnames.size()) ? s.channelnames[c].c_str() : "");
        fact(user, "type", s.channelformat(c).c_str());
    }
    std::string name(s.get_string_attribute("oiio:subimagename"));
    if (level > 0) name += "/level" + std::to_string(level);
    fact(user, "name", name.c_str());
    for (const char* key : kSpace)
        if (const auto* found = s.find_attribute(key)) {
            std::string text = std::string(key) + "=";
            if (found->type().basetype == OIIO::TypeDesc::UINT8) {  // a profile: its digest tells it apart
                std::uint64_t hash = 14695981039346656037u;
                for (std::size_t i = 0; i < found->type().size(); ++i) hash = (hash ^ static_cast<const unsigned char*>(found->data())[i]) * 1099511628211u;
                text += std::to_string(hash);
            } else
                text += s.metadata_val(*found);
            const bool usual = text == "PixelAspectRatio=1" || text.rfind("Orientation=1", 0) == 0 || (s.alpha_channel < 0 && std::string(key) == "oiio:UnassociatedAlpha");
            if (!usual) fact(user, "space", text.c_str());
        }
}

void read_rows(IsoparmImageFile& f, int number, int first, int rows, int kind, void* to) {
    const auto [subimage, level] = f.parts[number];
    if (!f.in->seek_subimage(subimage, level)) throw std::runtime_error(reason(f.in->geterror()));
    const OIIO::ImageSpec& s = f.in->spec();
    if (kind != 1) return read_native(*f.in, subimage, level, s, first, rows, kind == 2 ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::FLOAT, to);
    const std::size_t pixels = std::size_t(s.width) * rows;
    std::vector<unsigned char> native(pixels * s.pixel_bytes(true));
    const OIIO::TypeDesc as_stored = s.channelformats.empty() ? s.format : OIIO::TypeDesc(OIIO::TypeDesc::UNKNOWN);
    read_native(*f.in, subimage, level, s, first, rows, as_stored, native.data());
    exact_rows(s, native, pixels, static_cast<double*>(to));
}

OIIO::TypeDesc type_of(char letter) {
    switch (letter) {
        case 'h': return OIIO::TypeDesc::HALF;
        case 'b': return OIIO::TypeDesc::UINT8;
        case 's': return OIIO::TypeDesc::UINT16;
        case 'u': return OIIO::TypeDesc::UINT32;
        default: return OIIO::TypeDesc::FLOAT;
    }
}

OIIO::ImageSpec spec_of(const IsoparmImageLayer& l) {
    const IsoparmImagePart& p = l.part;
    OIIO::ImageSpec s(p.width, p.height, p.channels, type_of(l.types[0]));
    s.x = p.x, s.y = p.y, s.full_x = p.full_x, s.full_y = p.full_y, s.full_width = p.full_width, s.full_height = p.full_height;
    s.channelnames.assign(l.channels, l.channels + p.channels);
    s.alpha_channel = -1;
    for (int c = 0; c < p.channels; ++c) {
        if (s.channelnames[c] == "A") s.alpha_channel = c;
        if (l.types[c] != l.types[0]) s.channelformats.assign(p.channels, OIIO::TypeDesc::UNKNOWN);
    }
    for (std::size_t c = 0; c < s.channelformats.size(); ++c) s.channelformats[c] = type_of(l.types[c]);
    if (*l.name) s.attribute("oiio:subimagename", l.name), s.attribute("name", l.name);
    s.attribute("oiio:ColorSpace", l.space);
    s.attribute("oiio:UnassociatedAlpha", 1);
    s.attribute("DateTime", "");
    s.attribute("Software", "isoparm");
    return s;
}

}  // namespace

struct IsoparmImageWriter {
    std::string name, format;
    InMemory memory;
    std::unique_ptr<OIIO::ImageOutput> out;
    std::vector<OIIO::ImageSpec> specs;
    int open = -1;
};

namespace {

void go_to(IsoparmImageWriter& w, int layer) {
    while (w.open < layer) {
        const bool first = w.open < 0, several = w.specs.size() > 1;
        ++w.open;
        const bool good = !first ? w.out->open(w.name, w.specs[w.open], OIIO::ImageOutput::AppendSubimage)
                          : several ? w.out->open(w.name, int(w.specs.size()), w.specs.data())
                                    : w.out->open(w.name, w.specs[0]);
        if (!good) throw std::runtime_error(reason(w.out->geterror()));
    }
}

void put_rows(IsoparmImageWriter& w, int layer, int first, int rows, const float* data) {
    go_to(w, layer);
    const OIIO::ImageSpec& s = w.specs[layer];
    const std::size_t pixels = std::size_t(s.width) * rows;
    std::vector<unsigned char> native;
    const void* from = data;
    OIIO::TypeDesc type = OIIO::TypeDesc::FLOAT;
    if (any_exact(s)) {  // floats that mean whole numbers
        type = s.channelformats.empty() ? s.format : OIIO::TypeDesc(OIIO::TypeDesc::UNKNOWN);
        native.resize(pixels * s.pixel_bytes(true));
        unsigned char* to = native.data();
        for (std::size_t i = 0; i < pixels * s.nchannels; ++i) {
            const OIIO::TypeDesc t = s.channelformat(int(i % s.nchannels));
            if (const auto whole = static_cast<std::uint32_t>(data[i] > 0 ? data[i] : 0); t == OIIO::TypeDesc::UINT32) std::memcpy(to, &whole, sizeof whole);
            else OIIO::convert_pixel_values(OIIO::TypeDesc::FLOAT, data + i, t, to, 1);
            to += t.size();
        }
        from = native.data();
    }
    if (!w.out->write_scanlines(s.y + first, s.y + first + rows, s.z, type, from)) throw std::runtime_error(reason(w.out->geterror()));
}

/// 2.4.7 reports success for PNG on a full disk.
void read_back(const std::string& name, const std::string& format) {
    const auto in = opened_as(name.c_str(), format.c_str());
    for (int s = 0; in->seek_subimage(s, 0); ++s) {
        const OIIO::ImageSpec spec = in->spec();
        std::vector<float> rows(std::size_t(spec.width) * spec.nchannels * 64);
        for (int y = 0; y < spec.height; y += 64) read_native(*in, s, 0, spec, y, std::min(64, spec.height - y), OIIO::TypeDesc::FLOAT, rows.data());
    }
}

}  // namespace

int isoparm_image_write(const char* file, const char* format, const IsoparmImagePixels* pixels, int lossy, const char* const* names,
                        const char* const* values, int metadata, IsoparmImageError* error) {
    return guarded(error, [&] { write(file, format, *pixels, lossy != 0, names, values, metadata); });
}

int isoparm_image_read(const char* file, IsoparmImageSink sink, void* user, IsoparmImageError* error) {
    return guarded(error, [&] { read(file, sink, user); });
}

IsoparmImageFile* isoparm_image_open(const char* file, const char* format, IsoparmImageError* error) {
    auto f = std::make_unique<IsoparmImageFile>();
    const int failed = guarded(error, [&] {
        f->in = opened_as(file, format);
        find_parts(*f);
    });
    return failed ? nullptr : f.release();
}

int isoparm_image_part(IsoparmImageFile* file, int number, IsoparmImagePart* part, IsoparmImageFact fact, void* user, IsoparmImageError* error) {
    if (number < 0 || number >= int(file->parts.size())) return 1;
    return guarded(error, [&] { describe(*file, number, *part, fact, user); }) ? -1 : 0;
}

int isoparm_image_rows(IsoparmImageFile* file, int number, int first, int rows, int kind, void* to, IsoparmImageError* error) {
    return guarded(error, [&] { read_rows(*file, number, first, rows, kind, to); });
}

void isoparm_image_close(IsoparmImageFile* file) { delete file; }

IsoparmImageWriter* isoparm_image_create(const char* file, const char* format, const IsoparmImageLayer* layers, int count, IsoparmImageError* error) {
    auto w = std::make_unique<IsoparmImageWriter>();
    const int failed = guarded(error, [&] {
        w->name = file, w->format = format;
        w->out = OIIO::ImageOutput::create(format);
        if (!w->out) throw std::runtime_error(reason(OIIO::geterror()));
        w->memory.take(*w->out);
        for (int i = 0; i < count; ++i) w->specs.push_back(spec_of(layers[i]));
        go_to(*w, 0);
    });
    return failed ? nullptr : w.release();
}

int isoparm_image_put(IsoparmImageWriter* file, int layer, int first, int rows, const float* data, IsoparmImageError* error) {
    return guarded(error, [&] { put_rows(*file, layer, first, rows, data); });
}

int isoparm_image_finish(IsoparmImageWriter* file, IsoparmImageError* error) {
    const std::unique_ptr<IsoparmImageWriter> w(file);
    return guarded(error, [&] {
        if (!w->out->close() || w->out->has_error()) throw std::runtime_error(reason(w->out->geterror()));
        w->memory.store(w->name.c_str());
        read_back(w->name, w->format);
    });
}

void isoparm_image_threads(int threads) {
    OIIO::attribute("exr_threads", threads == 1 ? -1 : threads);
    if (threads == 1) hand_on_exr_threads();  // lists the formats, too: once, and not in every child
    const int workers = OIIO::default_thread_pool()->size();  // asking makes the pool, if there was none
    const std::size_t before = workers > 0 ? threads_of_process() : 0;
    OIIO::attribute("threads", threads);
    if (threads == 1 && workers > 0) await_end(before > std::size_t(workers) ? before - std::size_t(workers) : 1);
}
