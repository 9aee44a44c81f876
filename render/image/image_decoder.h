// image_decoder.h -- image files that nobody vouches for, read by rows in a process of their own.
//
// The header is checked first (image_header.h); then a child process with limits on memory and time decodes, and hands rows over through
// shared memory. Whatever a damaged or hostile file does to the decoder, it does to the child: here it is an Error(io) that names the file.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace isoparm {

struct ImageLimits {
    std::uint64_t pixels = std::uint64_t{1} << 29;  // of all parts of a file
    std::size_t memory = std::size_t{768} << 20;    // bytes that decoding may take beyond what the program has
    int seconds = 120;                              // of processor time for a file, and of waiting for a block of rows
    int threads = 0;                                // of the decoder, at most 8; 0: as many as there are processors
};

struct ImageWindow {
    int x = 0, y = 0, width = 0, height = 0;
    bool operator==(const ImageWindow&) const = default;
};

struct ImagePart {
    std::string name;
    ImageWindow data, display;
    std::vector<std::string> channels, types;  // types: "half", "uint8"
    std::vector<std::string> space;            // "oiio:ColorSpace=sRGB": what the numbers mean
    int tile_height = 0;
    bool exact = false;                        // holds numbers that floats would round: ask for doubles
    bool integers = false;                     // none of the channels is of floating point
    bool halves = false;                       // all channels are half floats
};

/// How rows are handed over.
enum class RowKind { floats, doubles, halves };

class ImageDecoder {
public:
    /// Checks the header and starts the child. Throws Error(io). Not to be used from two threads.
    ImageDecoder(const std::string& path, const ImageLimits& limits);
    ~ImageDecoder();
    ImageDecoder(const ImageDecoder&) = delete;
    ImageDecoder& operator=(const ImageDecoder&) = delete;

    /// Waits for what the decoder finds in the file; to be called once, before anything below. Throws Error(io).
    void open();
    const std::string& path() const { return path_; }
    const std::vector<ImagePart>& parts() const { return parts_; }
    /// As many rows as one block can have of that part.
    int most_rows(int part) const;
    /// From now on blocks of `rows` rows of that part.
    void begin(int part, int rows, RowKind kind);
    /// Block k begins at row k * rows, channels interleaved; valid until the next call. While it is looked at, the child decodes the next.
    const void* block(int k);

private:
    struct Child;
    void ask(int k);
    void wait();
    [[noreturn]] void fail(const std::string& what) const;
    [[noreturn]] void child_is_gone();
    std::string receive_text();
    void receive(void* to, std::size_t size);
    std::string path_;
    ImageLimits limits_;
    std::unique_ptr<Child> child_;
    std::vector<ImagePart> parts_;
    int part_ = 0, rows_ = 0, pending_ = -1;
    RowKind kind_ = RowKind::floats;
};

}  // namespace isoparm
