#include "glb_reader.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <set>

#include "error.h"
#include "io/extension.h"
#include "io/mesh_scanner.h"
#include "scene/json.h"

namespace isoparm {
namespace {

constexpr std::size_t kMostBytes = std::size_t{64} << 30;
/// Vertices, and corners, that nodes or primitives may make of bytes that were read before.
constexpr std::size_t kMostShared = 20'000'000;
constexpr std::size_t kMostPrimitives = 200'000, kMostKeys = 100;  // shown, counting again what is shown again; of an object, which are looked through each time

using Kind = Json::Kind;

/// Column by column, as glTF has them.
struct Matrix {
    double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    Point operator()(const Point& p) const {
        return {m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13], m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
    }
    bool identity() const { return std::memcmp(m, Matrix{}.m, sizeof m) == 0; }
    friend Matrix operator*(const Matrix& a, const Matrix& b) {
        Matrix r;
        for (int c = 0; c < 4; ++c)
            for (int i = 0; i < 4; ++i) {
                r.m[4 * c + i] = 0;
                for (int k = 0; k < 4; ++k) r.m[4 * c + i] += a.m[4 * k + i] * b.m[4 * c + k];
            }
        return r;
    }
};

/// Readers must refuse files that require what they do not know. These change no vertex.
bool leaves_shape_alone(const std::string& extension) {
    if (extension.rfind("KHR_materials_", 0) == 0) return true;
    for (const char* known : {"KHR_texture_transform", "KHR_texture_basisu", "EXT_texture_webp", "EXT_texture_avif", "KHR_lights_punctual", "KHR_xmp_json_ld"})
        if (extension == known) return true;
    return false;
}

class GlbReader {
public:
    GlbReader(const std::string& bytes, const std::string& path) : path_(path), size_(bytes.size()), root_(Json::parse(chunks(bytes), path + " (JSON)")) {}

    MeshFile run() {
        file_.format = "glTF, binary";
        object(root_);
        const Json asset = root_.at("asset", "the key of every glTF file");
        if (const Json version = text(asset, "version"); version.string().rfind("2.", 0) != 0) version.expected("version 2.0 of glTF");
        if (asset.find("minVersion"))
            if (const Json version = text(asset, "minVersion"); version.string() != "2.0") version.expected("version 2.0 of glTF");
        if (const auto needed = root_.find("extensionsRequired"))
            for (const Json& name : list(*needed))
                if (!name.is(Kind::string) || !leaves_shape_alone(name.string())) name.expected("no extension but such as say how surfaces look");
        nodes();
        file_.welded = weld_equal_points(file_.mesh);
        return std::move(file_);
    }

private:
    // ---- the container: a header, a chunk of JSON, a binary one, perhaps others
    std::string chunks(const std::string& bytes) {
        ByteScanner in(bytes, 0, path_, false);
        const auto word = [&](std::uint32_t wanted, const char* expected) {
            if (const auto found = in.number<std::uint32_t>(expected); found != wanted) in.fail(std::to_string(found), expected);
        };
        word(0x46546C67, "\"glTF\", with which a .glb file begins");
        word(2, "version 2 of the container");
        if (const auto length = in.number<std::uint32_t>("the length of the file"); length != bytes.size()) in.fail("a length of " + std::to_string(length) + " in a file of " + std::to_string(bytes.size()) + " bytes", "that of the file");
        const std::uint32_t size = in.number<std::uint32_t>("the length of the JSON chunk");
        word(0x4E4F534A, "a chunk of type \"JSON\"");
        const std::size_t json = in.offset();
        in.skip(size, "the bytes of the JSON chunk");
        if (in.left() > 0) {
            const std::uint32_t more = in.number<std::uint32_t>("the length of the next chunk"), type = in.number<std::uint32_t>("the type of the next chunk");
            const std::size_t binary = in.offset();
            in.skip(more, "the bytes of the chunk");
            if (type == 0x004E4942) binary_ = std::string_view(bytes).substr(binary, more);
        }
        return bytes.substr(json, size);
    }

    // ---- values of the JSON
    static std::vector<Json> list(const Json& j) {
        if (!j.is(Kind::array)) j.expected("an array");
        return j.children();
    }
    static const Json& object(const Json& j) {
        if (!j.is(Kind::object) || j.size() > kMostKeys) j.expected("an object of at most " + std::to_string(kMostKeys) + " keys");
        return j;
    }
    static Json text(const Json& j, const char* key) {
        object(j);
        const Json t = j.at(key, "a text");
        if (!t.is(Kind::string)) t.expected("a text");
        return t;
    }
    static std::size_t whole(const Json& j, std::size_t most, const std::string& expected) {
        if (!j.is(Kind::number) || !(j.number() >= 0 && j.number() <= double(most)) || j.number() != std::floor(j.number())) j.expected(expected);
        return static_cast<std::size_t>(j.number());
    }
    static std::size_t whole(const Json& j, const char* key, std::size_t otherwise, std::size_t most) {
        const auto found = object(j).find(key);
        return found ? whole(*found, most, "a whole number from 0 to " + std::to_string(most)) : otherwise;
    }
    /// The element of the list `name` that j is the index of.
    Json element(const char* name, const Json& j) const {
        const auto all = root_.find(name);
        const std::size_t n = all && all->is(Kind::array) ? all->size() : 0;
        if (n == 0) j.fail(std::string("found no ") + name + " in the file, expected some");
        return object((*all)[whole(j, n - 1, std::string("an index of ") + name + ", from 0 to " + std::to_string(n - 1))]);
    }
    static void numbers(const Json& j, std::size_t n, double* to) {
        if (!j.is(Kind::array) || j.size() != n) j.expected(std::to_string(n) + " numbers");
        for (const Json& x : j.children()) {
            if (!x.is(Kind::number) || !std::isfinite(x.number())) x.expected("a finite number");
            *to++ = x.number();
        }
    }

    // ---- nodes
    static Matrix matrix_of(const Json& node) {
        Matrix all;
        if (const auto m = node.find("matrix")) {
            numbers(*m, 16, all.m);
            return all;
        }
        if (const auto t = node.find("translation")) numbers(*t, 3, all.m + 12);
        if (const auto r = node.find("rotation")) {
            double q[4];
            numbers(*r, 4, q);
            const auto [x, y, z, w] = q;
            Matrix turn;
            const double rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
            for (int k = 0; k < 9; ++k) turn.m[k / 3 * 4 + k % 3] = rows[k];
            all = all * turn;
        }
        if (const auto s = node.find("scale")) {
            double by[3];
            numbers(*s, 3, by);
            for (int k = 0; k < 12; ++k) all.m[k] *= by[k / 4];
        }
        return all;
    }
    /// Without recursion, which a chain of a million nodes would let run over the stack. Each node has one place: a second one would be a loop.
    void nodes() {
        struct Place {
            Json node;
            Matrix matrix;
        };
        std::vector<Place> left;
        std::set<std::size_t> seen;
        const auto add = [&](const Json& index, const Matrix& matrix) {
            const Json node = element("nodes", index);
            if (!seen.insert(static_cast<std::size_t>(index.number())).second) index.fail("found node " + index.description() + " for the second time, expected nodes that form trees");
            left.push_back({node, matrix * matrix_of(node)});
        };
        const auto all = root_.find("nodes"), scenes = root_.find("scenes");
        if (scenes && scenes->is(Kind::array) && scenes->size() > 0) {
            const Json scene = (*scenes)[whole(root_, "scene", 0, scenes->size() - 1)];
            if (const auto roots = object(scene).find("nodes"))
                for (const Json& index : list(*roots)) add(index, {});
        } else if (all) {
            all->fail("found nodes without a scene that shows them, expected one");
        }
        while (!left.empty()) {
            const Place at = left.back();
            left.pop_back();
            if (const auto index = at.node.find("mesh")) mesh(element("meshes", *index), at.matrix);
            if (const auto children = at.node.find("children"))
                for (const Json& index : list(*children)) add(index, at.matrix);
        }
    }

    // ---- meshes
    /// Where the elements of an accessor lie, checked against the bytes that are there.
    struct Elements {
        const char* at;
        std::size_t count, stride;
    };
    Elements elements(const Json& a, std::size_t element_size) const {
        if (const auto sparse = a.find("sparse")) sparse->fail_at_key("found a sparse accessor, expected one whose numbers all stand in a buffer");
        const Json view = element("bufferViews", a.at("bufferView", "the numbers of the accessor"));
        if (const Json buffer = view.at("buffer", "the index of a buffer"); whole(buffer, SIZE_MAX >> 12, "the index of a buffer") != 0) buffer.expected("0: the file's own binary chunk");
        if (const Json buffer = element("buffers", view.at("buffer", "0")); buffer.find("uri")) buffer.fail("found a buffer in another file, expected the binary chunk of this one");
        const std::size_t begin = whole(view, "byteOffset", 0, binary_.size()), length = whole(view, "byteLength", 0, binary_.size() - begin);
        const std::size_t stride = whole(view, "byteStride", element_size, 252), offset = whole(a, "byteOffset", 0, length), count = whole(a, "count", 0, kMostElements);
        if (stride < element_size) view.fail("found a stride of " + std::to_string(stride) + " bytes, expected at least " + std::to_string(element_size));
        if (count == 0) a.fail("found no count of elements, expected at least one");
        if (length - offset < element_size || (count - 1) > (length - offset - element_size) / stride)
            a.fail("found " + std::to_string(count) + " elements in " + std::to_string(length - offset) + " bytes, expected as many as fit");
        return {binary_.data() + begin + offset, count, stride};
    }
    template <class T> static T number(const char* at) {
        char bytes[sizeof(T)];
        std::memcpy(bytes, at, sizeof(T));
        if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof(T));
        T x;
        std::memcpy(&x, bytes, sizeof(T));
        return x;
    }
    void limit(const Json& j, std::size_t now, std::size_t more, std::size_t each) const {
        if (now + more > size_ / each + kMostShared || now + more > kMostElements) j.fail("found " + std::to_string(now + more) + " vertices or corners in a file of " + std::to_string(size_) + " bytes, expected fewer that are used again");
    }
    std::size_t component(const Json& a, const char* type) const {
        if (const Json t = text(a, "type"); t.string() != type) t.expected(std::string("\"") + type + "\"");
        return whole(a.at("componentType", "5121, 5123, 5125 or 5126"), 65535, "5121, 5123, 5125 or 5126");
    }
    std::vector<std::uint32_t> indices(const Json& primitive, std::size_t vertices) const {
        std::vector<std::uint32_t> all;
        const auto index = primitive.find("indices");
        if (!index) {
            limit(primitive, corners_, vertices, 12);
            for (std::size_t k = 0; k < vertices; ++k) all.push_back(static_cast<std::uint32_t>(k));
            return all;
        }
        const Json a = element("accessors", *index);
        const std::size_t kind = component(a, "SCALAR");
        if (kind != 5121 && kind != 5123 && kind != 5125) a.fail("found indices of component type " + std::to_string(kind) + ", expected 5121, 5123 or 5125");
        const Elements e = elements(a, kind == 5121 ? 1 : kind == 5123 ? 2 : 4);
        limit(a, corners_, e.count, 1);
        all.reserve(e.count);
        for (std::size_t k = 0; k < e.count; ++k) {
            const char* at = e.at + k * e.stride;
            const std::uint32_t i = kind == 5121 ? number<std::uint8_t>(at) : kind == 5123 ? number<std::uint16_t>(at) : number<std::uint32_t>(at);
            if (i >= vertices) a.fail("found the index " + std::to_string(i) + " as number " + std::to_string(k) + ", expected one below " + std::to_string(vertices) + ", the number of vertices");
            all.push_back(i);
        }
        return all;
    }
    void mesh(const Json& mesh, const Matrix& matrix) {
        const Json all = mesh.at("primitives", "an array of primitives");
        if ((primitives_ += all.size()) > kMostPrimitives) all.fail("found more than " + std::to_string(kMostPrimitives) + " primitives, expected fewer");
        for (const Json& p : list(all)) {
            const std::size_t mode = whole(p, "mode", 4, 6);
            if (mode < 4) continue;  // points and lines
            const Json attributes = p.at("attributes", "an object with POSITION");
            const Json a = element("accessors", object(attributes).at("POSITION", "the accessor of the positions"));
            if (const std::size_t kind = component(a, "VEC3"); kind != 5126) a.fail("found positions of component type " + std::to_string(kind) + ", expected 5126, float32");
            const Elements e = elements(a, 12);
            limit(a, file_.mesh.points.size(), e.count, 12);
            const std::size_t first = file_.mesh.points.size();
            for (std::size_t k = 0; k < e.count; ++k) {
                const char* at = e.at + k * e.stride;
                const Point stored{number<float>(at), number<float>(at + 4), number<float>(at + 8)};
                const Point x = matrix.identity() ? stored : matrix(stored);
                for (int axis = 0; axis < 3; ++axis)
                    if (!(std::fabs(x[axis]) <= 1e50)) a.fail("found the coordinate " + to_text(x[axis]) + " of vertex " + std::to_string(k) + ", expected a finite number of at most 1e50 in size");
                file_.mesh.points.push_back(x);
            }
            const std::vector<std::uint32_t> corners = indices(p, e.count);
            corners_ += corners.size();
            add_triangles(mode, corners, first);
        }
    }
    void add_triangles(std::size_t mode, const std::vector<std::uint32_t>& corners, std::size_t first) {
        const auto at = [&](std::size_t k) { return static_cast<std::uint32_t>(first + corners[k]); };
        for (std::size_t k = 0; k + 2 < corners.size(); k += mode == 4 ? 3 : 1) {
            if (mode == 4) file_.mesh.triangles.push_back({at(k), at(k + 1), at(k + 2)});
            if (mode == 5) file_.mesh.triangles.push_back({at(k), at(k + 1 + k % 2), at(k + 2 - k % 2)});
            if (mode == 6) file_.mesh.triangles.push_back({at(k + 1), at(k + 2), at(0)});
        }
    }

    const std::string& path_;
    std::size_t size_, corners_ = 0, primitives_ = 0;
    std::string_view binary_;
    Json root_;
    MeshFile file_;
};

}  // namespace

MeshFile read_glb(const std::string& bytes, const std::string& path) {
    MeshFile file = GlbReader(bytes, path).run();
    if (file.mesh.triangles.empty()) throw_input(path + ": found no triangle, expected at least one");
    return file;
}

void require_mesh_file(const std::string& path) {
    if (const std::string extension = extension_of(path); extension != ".ply" && extension != ".obj" && extension != ".stl" && extension != ".glb")
        throw Error(ErrorKind::usage, path + ": found the extension " + in_quotes(extension) + ", expected .ply, .obj, .stl or .glb");
}

MeshFile read_mesh_file(const std::string& path) {
    require_mesh_file(path);
    const std::string bytes = read_text_file(path, kMostBytes);
    return extension_of(path) == ".glb" ? read_glb(bytes, path) : read_mesh(bytes, path);
}

}  // namespace isoparm
