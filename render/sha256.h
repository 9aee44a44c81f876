// sha256.h -- the digest of a file, as sha256sum prints it (FIPS 180-4).
#pragma once
#include <string>

namespace isoparm {
/// 64 hexadecimal digits.
std::string sha256(const std::string& bytes);
}  // namespace isoparm
