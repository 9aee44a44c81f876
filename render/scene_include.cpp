#include "scene_include.h"

#include "included_file.h"

namespace isoparm {

IncludedFile read_included(const Json& name, const SceneValues& values, const std::string& what) {
    const std::string file = included_file(name, values.text(name, "the name of " + what + ", relative to the scene"));
    try {
        return {read_text_file(file), file};
    } catch (const Error& e) {
        name.fail("found a file that cannot be used, expected " + what + ": " + e.what());
    }
}

}  // namespace isoparm
