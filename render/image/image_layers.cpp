#include "image/image_layers.h"

#include <algorithm>

#include "error.h"
#include "image/image_loader.h"
#include "io/atomic_file.h"
#include "io/extension.h"

namespace isoparm {
namespace {

char letter_of(const std::string& type) { return type == "half" ? 'h' : type == "uint8" ? 'b' : type == "uint16" ? 's' : type == "uint32" ? 'u' : 'f'; }

}  // namespace

float& ImageLayer::at(int x, int y, const std::string& channel) {
    const auto c = std::find(part.channels.begin(), part.channels.end(), channel) - part.channels.begin();
    return values.at((static_cast<std::size_t>(y) * static_cast<std::size_t>(part.data.width) + static_cast<std::size_t>(x)) * part.channels.size() + static_cast<std::size_t>(c));
}

ImageLayer make_layer(const std::string& name, int width, int height, const std::vector<std::string>& channels, const std::vector<std::string>& types) {
    ImageLayer l;
    l.part.name = name, l.part.channels = channels, l.part.types = types;
    l.part.data = l.part.display = {0, 0, width, height};
    l.values.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * channels.size(), 0);
    return l;
}

void write_layers(const std::string& path, const std::vector<ImageLayer>& layers) {
    std::vector<std::vector<const char*>> names(layers.size());
    std::vector<std::string> types(layers.size());
    std::vector<IsoparmImageLayer> all;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const ImagePart& p = layers[i].part;
        for (const std::string& c : p.channels) names[i].push_back(c.c_str());
        for (const std::string& t : p.types) types[i] += letter_of(t);
        all.push_back({{p.data.x, p.data.y, p.data.width, p.data.height, p.display.x, p.display.y, p.display.width, p.display.height, static_cast<int>(p.channels.size()), 0, 0, 0, 1},
                       p.name.c_str(), names[i].data(), types[i].c_str(), layers[i].space.c_str()});
    }
    const ImageModule& module = image_module();
    module.threads(1);
    write_atomically_by_name(path, [&](const std::string& file) {
        IsoparmImageError error{};
        const auto check = [&](bool good) {
            if (!good) throw Error(ErrorKind::io, path + ": writing the image failed: " + error.text);
        };
        IsoparmImageWriter* writer = module.create(file.c_str(), extension_of(path).substr(1).c_str(), all.data(), static_cast<int>(all.size()), &error);
        check(writer);
        for (std::size_t i = 0; i < layers.size(); ++i)
            if (module.put(writer, static_cast<int>(i), 0, layers[i].part.data.height, layers[i].values.data(), &error) != 0) {
                IsoparmImageError ignored{};
                module.finish(writer, &ignored);
                check(false);
            }
        check(module.finish(writer, &error) == 0);
    });
}

}  // namespace isoparm
