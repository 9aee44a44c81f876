#include "image/image_loader.h"

#include "module.h"

namespace isoparm {
namespace {

template <class F> void find(const char* name, F& function) { function = module_function<F>("isoparm_image", name); }

ImageModule load_functions() {
    ImageModule m{};
    find("isoparm_image_write", m.write);
    find("isoparm_image_read", m.read);
    find("isoparm_image_open", m.open);
    find("isoparm_image_part", m.part);
    find("isoparm_image_rows", m.rows);
    find("isoparm_image_close", m.close);
    find("isoparm_image_create", m.create);
    find("isoparm_image_put", m.put);
    find("isoparm_image_finish", m.finish);
    find("isoparm_image_threads", m.threads);
    return m;
}

}  // namespace

const ImageModule& image_module() {
    static const ImageModule loaded = load_functions();
    return loaded;
}

}  // namespace isoparm
