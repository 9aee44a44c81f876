#include "sha256.h"

#include <array>
#include <bit>
#include <cstdint>

namespace isoparm {
namespace {

using Word = std::uint32_t;

/// The first 32 bits of the fractions of roots of the first primes: cube roots of 64, square roots of 8.
struct Constants {
    std::array<Word, 64> k{};
    std::array<Word, 8> start{};
    Constants() {
        int found = 0;
        for (unsigned p = 2; found < 64; ++p) {
            bool prime = true;
            for (unsigned d = 2; d * d <= p; ++d) prime = prime && p % d != 0;
            if (!prime) continue;
            if (found < 8) start[found] = fraction(p, 2);
            k[found++] = fraction(p, 3);
        }
    }
    /// The largest x below 2^32 times the root, by bits: x^power <= p 2^(32 power).
    static Word fraction(unsigned p, int power) {
        unsigned __int128 x = 0;
        for (int bit = 36; bit >= 0; --bit) {
            const unsigned __int128 y = x | (static_cast<unsigned __int128>(1) << bit), bound = static_cast<unsigned __int128>(p)
                                                                                                << (32 * power);
            if ((power == 2 ? y * y : y * y * y) <= bound) x = y;
        }
        return static_cast<Word>(x);
    }
};

void add_block(std::array<Word, 8>& h, const unsigned char* block, const Constants& c) {
    std::array<Word, 64> w;
    for (int i = 0; i < 16; ++i)
        w[i] = Word(block[4 * i]) << 24 | Word(block[4 * i + 1]) << 16 | Word(block[4 * i + 2]) << 8 | block[4 * i + 3];
    for (int i = 16; i < 64; ++i) {
        const Word a = w[i - 15], b = w[i - 2];
        w[i] = w[i - 16] + w[i - 7] + (std::rotr(a, 7) ^ std::rotr(a, 18) ^ (a >> 3)) + (std::rotr(b, 17) ^ std::rotr(b, 19) ^ (b >> 10));
    }
    std::array<Word, 8> s = h;
    for (int i = 0; i < 64; ++i) {
        const Word one =
            s[7] + (std::rotr(s[4], 6) ^ std::rotr(s[4], 11) ^ std::rotr(s[4], 25)) + ((s[4] & s[5]) ^ (~s[4] & s[6])) + c.k[i] + w[i];
        const Word two = (std::rotr(s[0], 2) ^ std::rotr(s[0], 13) ^ std::rotr(s[0], 22)) + ((s[0] & s[1]) ^ (s[0] & s[2]) ^ (s[1] & s[2]));
        s = {one + two, s[0], s[1], s[2], s[3] + one, s[4], s[5], s[6]};
    }
    for (int i = 0; i < 8; ++i) h[i] += s[i];
}

}  // namespace

std::string sha256(const std::string& bytes) {
    static const Constants constants;
    std::string padded = bytes + '\x80';
    padded.resize((padded.size() + 8 + 63) / 64 * 64 - 8, '\0');
    for (int i = 7; i >= 0; --i) padded += static_cast<char>(static_cast<std::uint64_t>(bytes.size()) * 8 >> (8 * i) & 255);
    std::array<Word, 8> h = constants.start;
    for (std::size_t i = 0; i < padded.size(); i += 64) add_block(h, reinterpret_cast<const unsigned char*>(padded.data()) + i, constants);
    static constexpr char digits[] = "0123456789abcdef";
    std::string text;
    for (const Word word : h)
        for (int shift = 28; shift >= 0; shift -= 4) text += digits[word >> shift & 15];
    return text;
}

}  // namespace isoparm
