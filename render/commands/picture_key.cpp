#include "commands/picture_key.h"

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "error.h"
#include "provenance.h"
#include "scene/json.h"
#include "sha256.h"

namespace isoparm {
namespace {

/// Embree's results differ between them.
std::string instructions() {
    std::string isa = "other";
#if defined(__x86_64__)
    isa = __builtin_cpu_supports("avx512f") ? "avx512" : __builtin_cpu_supports("avx2") ? "avx2" : "sse";
#endif
    const char* config = std::getenv("ISOPARM_EMBREE");
    for (const char c : std::string(config ? config : ""))
        if (c > ' ' && c < 127) isa += c;
    return isa;
}

constexpr std::size_t kMostBytes = std::size_t{1} << 30;  // images are larger than scenes

std::string text_of(const Tolerance& t) { return std::to_string(static_cast<int>(t.unit)) + ":" + to_text(t.value); }

}  // namespace

std::string picture_key(const Scene& scene, const RenderOptions& how, const Options& options) {
    std::ostringstream key;
    key << "program " << program_version() << ", " << compiler_name() << "\nprocessor " << instructions() << "\nscene " << sha256(read_text_file(scene.path)) << "\n";
    for (std::size_t i = 0; i < scene.included.size(); ++i) key << "included-file-" << i + 1 << " " << sha256(read_text_file(scene.included[i], kMostBytes)) << "\n";
    for (const auto& [name, value] : scene.parameters) key << "parameter-" << name << " " << to_text(value) << "\n";
    if (const auto camera = options.value("--camera")) key << "camera-file " << sha256(read_text_file(*camera)) << "\n";
    key << "size " << (how.width ? how.width : scene.image.width) << "x" << (how.height ? how.height : scene.image.height) << "\n";
    key << "crop ";
    if (how.crop) key << (*how.crop)[0] << "," << (*how.crop)[1] << "," << (*how.crop)[2] << "," << (*how.crop)[3];
    key << "\nsamples " << how.most_samples(scene.image) << "\nnoise " << to_text(how.noise.value_or(scene.image.noise));
    key << "\ntolerance " << text_of(how.tolerance.value_or(scene.tolerance)) << "\nexact-rays " << (how.exact ? "yes" : "no") << "\nlines-apart " << (how.vectors ? "yes" : "no");
    key << "\npixels-per-point " << to_text(how.pixels_per_point) << "\nfont-size " << (how.letter_points ? to_text(*how.letter_points) : "of-the-scene") << "\n";
    return key.str();
}

}  // namespace isoparm
