#include "module.h"

#include <dlfcn.h>

#include <filesystem>

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

}  // namespace

std::string find_module(const std::string& name) {
    const fs::path beside = program_folder();
    for (const fs::path& folder : {beside, beside.parent_path() / "lib" / "isoparm"})
        for (const char* prefix : {"", "lib"}) {
            std::error_code ignored;
            const fs::path file = folder / (prefix + name + ".so");
            if (fs::exists(file, ignored)) return file.string();
        }
    return "";
}

void* module_function(const std::string& name, const char* function) {
    const std::string file = find_module(name);
    if (file.empty()) {
        const fs::path beside = program_folder();
        throw Error(ErrorKind::io, "the module " + name + ".so was found neither in " + beside.string() + " nor in " +
                                       (beside.parent_path() / "lib" / "isoparm").string() + "; build or install isoparm again");
    }
    void* library = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL);  // looking all symbols up takes most of the time
    if (!library) throw Error(ErrorKind::io, file + ": the module cannot be loaded: " + dlerror());
    void* found = dlsym(library, function);
    if (!found) throw Error(ErrorKind::io, file + ": found another program's library, or another version's, expected the module " + name);
    return found;
}

}  // namespace isoparm
