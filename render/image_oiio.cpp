// image_oiio.cpp -- the module isoparm_image.so: the only file that includes OpenImageIO. Loaded when an image is first
// read or written, because linking OpenImageIO costs half a second at every start.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "image_module.h"

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

std::unique_ptr<OIIO::ImageInput> opened(const char* file) {
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);
    auto in = OIIO::ImageInput::open(file, &as_stored);
    if (!in) throw std::runtime_error(reason(OIIO::geterror()));
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

void check_written(const char* file, const IsoparmImagePixels& p, const void* data, OIIO::TypeDesc format, bool lossy) {
    const auto in = opened(file);
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

void write_pixels(const char* file, const OIIO::ImageSpec& spec, OIIO::TypeDesc format, const void* data) {
    const auto out = OIIO::ImageOutput::create(file);
    if (!out) throw std::runtime_error(reason(OIIO::geterror()));
    if (!out->open(file, spec) || !out->write_image(format, data)) throw std::runtime_error(reason(out->geterror()));
    if (!out->close() || out->has_error()) throw std::runtime_error(reason(out->geterror()));
}

void write_layers(const char* file, const IsoparmImagePixels& p, const char* const* names, const char* const* values, int metadata) {
    const std::vector<float> data = all_channels(p);
    OIIO::ImageSpec spec(p.width, p.height, p.channels + p.layers, OIIO::TypeDesc::FLOAT);
    spec.channelnames.resize(p.channels);  // R, G, B and perhaps A
    spec.channelnames.insert(spec.channelnames.end(), p.layer_names, p.layer_names + p.layers);
    spec.channelformats.assign(p.channels, OIIO::TypeDesc::HALF);
    spec.channelformats.resize(spec.nchannels, OIIO::TypeDesc::FLOAT);
    spec.attribute("oiio:ColorSpace", "Linear");
    set_metadata(spec, names, values, metadata);
    write_pixels(file, spec, OIIO::TypeDesc::FLOAT, data.data());
    const auto in = opened(file);
    const bool same_size = in->spec().width == p.width && in->spec().height == p.height && in->spec().nchannels == spec.nchannels;
    if (!same_size || in_order(floats(*in), in->spec().channelnames, spec.channelnames) != data)
        throw std::runtime_error("the file does not read back as it was written; is the disk full?");
}

void write(const char* file, const IsoparmImagePixels& p, bool lossy, const char* const* names,
           const char* const* values, int metadata) {
    if (p.layers > 0) return write_layers(file, p, names, values, metadata);
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
    set_metadata(spec, names, values, metadata);
    write_pixels(file, spec, format, data);
    check_written(file, p, data, format, lossy);  // 2.4.7 reports success for PNG on a full disk
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

}  // namespace

int isoparm_image_write(const char* file, const IsoparmImagePixels* pixels, int lossy, const char* const* names,
                        const char* const* values, int metadata, IsoparmImageError* error) {
    return guarded(error, [&] { write(file, *pixels, lossy != 0, names, values, metadata); });
}

int isoparm_image_read(const char* file, IsoparmImageSink sink, void* user, IsoparmImageError* error) {
    return guarded(error, [&] { read(file, sink, user); });
}
