// io/atomic_file.h -- a file that appears whole or not at all.
#pragma once
#include <functional>
#include <ostream>
#include <string>

namespace isoparm {
/// `write` fills the temporary file PATH.tmp-<pid>-<n> in the same folder; it is then flushed, checked, synced and
/// renamed to `path`. On any failure the temporary is removed, the old file is as it was, and Error(io) says why.
void write_atomically(const std::string& path, const std::function<void(std::ostream&)>& write);
/// The same when another library does the writing: `write` gets the temporary's name (with the extension of `path`).
void write_atomically_by_name(const std::string& path, const std::function<void(const std::string&)>& write);
}
