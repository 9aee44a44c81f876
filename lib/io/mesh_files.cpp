#include "io/mesh_files.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <ostream>
#include <sstream>

#include "error.h"
#include "io/atomic_file.h"
#include "io/extension.h"

namespace isoparm {

namespace {

template <class T> void put(std::string& out, T value) {
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof value);
    out.append(bytes, sizeof value);
}

/// Collects small pieces; a stream takes them by the megabyte.
class Buffer {
public:
    explicit Buffer(std::ostream& out) : out_(out) { text_.reserve(kBlock + 512); }
    ~Buffer() { out_.write(text_.data(), static_cast<std::streamsize>(text_.size())); }
    Buffer(const Buffer&) = delete;
    Buffer& operator=(const Buffer&) = delete;
    std::string& next() {
        if (text_.size() >= kBlock) {
            out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
            text_.clear();
        }
        return text_;
    }

private:
    static constexpr std::size_t kBlock = 1 << 20;
    std::ostream& out_;
    std::string text_;
};

void append(std::string& out, double x) {
    char text[32];
    out.append(text, std::to_chars(text, text + sizeof text, x).ptr);
}
void append(std::string& out, std::uint32_t x) {
    char text[16];
    out.append(text, std::to_chars(text, text + sizeof text, x).ptr);
}

/// Every line of the text behind a prefix.
std::string each_line(const std::string& prefix, const std::string& text) {
    std::istringstream in(text);
    std::string r;
    for (std::string line; std::getline(in, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        r += prefix + line + "\n";
    }
    return r;
}

struct FloatPoint {
    float x, y, z;
    bool operator==(const FloatPoint& o) const { return x == o.x && y == o.y && z == o.z; }
};
FloatPoint to_float(const Point& p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }
void put(std::string& out, const FloatPoint& p) {
    put(out, p.x);
    put(out, p.y);
    put(out, p.z);
}
FloatPoint facet_normal(const Point& a, const Point& b, const Point& c) {
    const Point n = cross(b - a, c - a);
    const double l = length(n);
    return l > 0 ? to_float(n / l) : FloatPoint{0, 0, 0};
}

template <class F> void each_triangle(const Mesh& mesh, F use) {
    for (const MeshPart& part : mesh.parts)
        for (const auto& t : part.triangles) use(part.vertex[t[0]], part.vertex[t[1]], part.vertex[t[2]]);
}

}  // namespace

void write_ply(std::ostream& out, const Mesh& mesh, const std::string& comment) {
    Buffer buffer(out);
    buffer.next() += "ply\nformat binary_little_endian 1.0\n" + each_line("comment ", comment) + "element vertex " +
                     std::to_string(mesh.positions.size()) + "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                     std::to_string(mesh.triangle_count()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    for (const Point& p : mesh.positions) {
        std::string& text = buffer.next();
        put(text, p.x);
        put(text, p.y);
        put(text, p.z);
    }
    each_triangle(mesh, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        std::string& text = buffer.next();
        text += '\3';
        put(text, a);
        put(text, b);
        put(text, c);
    });
}

void write_obj(std::ostream& out, const Mesh& mesh, const std::string& comment) {
    Buffer buffer(out);
    buffer.next() += each_line("# ", comment);
    for (const Point& p : mesh.positions) {
        std::string& text = buffer.next();
        for (int i = 0; i < 3; ++i) {
            text += i == 0 ? "v " : " ";
            append(text, p[i]);
        }
        text += '\n';
    }
    for (const MeshPart& part : mesh.parts) {
        std::string name = part.name;
        for (char& c : name)
            if (std::isspace(static_cast<unsigned char>(c)) || static_cast<unsigned char>(c) < 0x20) c = '_';
        buffer.next() += "g " + name + "\n";
        for (const auto& t : part.triangles) {
            std::string& text = buffer.next();
            text += 'f';
            for (const std::uint32_t corner : t) {
                text += ' ';
                append(text, part.vertex[corner] + 1);
            }
            text += '\n';
        }
    }
}

std::size_t write_stl(std::ostream& out, const Mesh& mesh) {
    std::size_t kept = 0, dropped = 0;
    const auto collapses = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const FloatPoint p = to_float(mesh.positions[a]), q = to_float(mesh.positions[b]), r = to_float(mesh.positions[c]);
        return p == q || q == r || r == p;
    };
    each_triangle(mesh, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) { ++(collapses(a, b, c) ? dropped : kept); });
    if (kept > 0xFFFFFFFFu) throw Error(ErrorKind::io, "STL cannot hold more than 4294967295 triangles; write PLY");

    Buffer buffer(out);
    std::string header = "isoparm, binary STL";  // must not begin with "solid"
    header.resize(80, ' ');
    buffer.next() += header;
    put(buffer.next(), static_cast<std::uint32_t>(kept));
    each_triangle(mesh, [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        if (collapses(a, b, c)) return;
        std::string& text = buffer.next();
        put(text, facet_normal(mesh.positions[a], mesh.positions[b], mesh.positions[c]));
        for (const std::uint32_t v : {a, b, c}) put(text, to_float(mesh.positions[v]));
        put(text, std::uint16_t{0});
    });
    return dropped;
}

void write_mesh(const std::string& path, const Mesh& mesh, const std::string& comment) {
    const std::string extension = extension_of(path);
    if (extension == ".ply") write_atomically(path, [&](std::ostream& out) { write_ply(out, mesh, comment); });
    else if (extension == ".obj") write_atomically(path, [&](std::ostream& out) { write_obj(out, mesh, comment); });
    else if (extension == ".stl") write_atomically(path, [&](std::ostream& out) { write_stl(out, mesh); });
    else throw Error(ErrorKind::usage, path + ": found the extension \"" + extension + "\", expected .ply, .obj or .stl");
}

}  // namespace isoparm
