#include "image_loader.h"

#include <dlfcn.h>

#include <filesystem>
#include <string>

#include "error.h"

namespace isoparm {
namespace {

namespace fs = std::filesystem;

fs::path program_folder() {
    std::error_code failed;
    fs::path program = fs::read_symlink("/proc/self/exe", failed);
    Dl_info info{};
    if (failed && dladdr(reinterpret_cast<void*>(&program_folder), &info) && info.dli_fname)
        program = fs::absolute(info.dli_fname, failed);
    return program.parent_path();
}

template <class F>
void find(void* library, const fs::path& file, const char* name, F& function) {
    function = reinterpret_cast<F>(dlsym(library, name));
    if (!function) throw Error(ErrorKind::io, file.string() + ": found another program's library, or another version's, expected the image module");
}

ImageModule functions(void* library, const fs::path& file) {
    ImageModule m{};
    find(library, file, "isoparm_image_write", m.write);
    find(library, file, "isoparm_image_read", m.read);
    find(library, file, "isoparm_image_open", m.open);
    find(library, file, "isoparm_image_part", m.part);
    find(library, file, "isoparm_image_rows", m.rows);
    find(library, file, "isoparm_image_close", m.close);
    find(library, file, "isoparm_image_create", m.create);
    find(library, file, "isoparm_image_put", m.put);
    find(library, file, "isoparm_image_finish", m.finish);
    find(library, file, "isoparm_image_threads", m.threads);
    return m;
}

ImageModule load_module() {
    const fs::path beside = program_folder();
    for (const fs::path& folder : {beside, beside.parent_path() / "lib" / "isoparm"})
        for (const char* name : {"isoparm_image.so", "libisoparm_image.so"}) {
            const fs::path file = folder / name;
            std::error_code ignored;
            if (!fs::exists(file, ignored)) continue;
            void* library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);
            if (!library)
                throw Error(ErrorKind::io, file.string() + ": the image module cannot be loaded: " + dlerror());
            return functions(library, file);
        }
    throw Error(ErrorKind::io, "the image module isoparm_image.so was found neither in " + beside.string() +
                                   " nor in " + (beside.parent_path() / "lib" / "isoparm").string() +
                                   "; build or install isoparm again");
}

}  // namespace

const ImageModule& image_module() {
    static const ImageModule loaded = load_module();
    return loaded;
}

}  // namespace isoparm
