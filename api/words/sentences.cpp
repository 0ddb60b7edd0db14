#include "api/words/sentences.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace api {

namespace {

constexpr std::size_t kLongestWord =
    40; // names of ours are shorter, and slips are counted in a table this wide

char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

// Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours.
// Source: Damerau 1964, restricted form; words of at most kLongestWord bytes.
std::size_t typing_slips(std::string_view a, std::string_view b)
{
    std::array<std::array<std::size_t, kLongestWord + 1>, 3> rows{};
    for (std::size_t j = 0; j <= b.size(); ++j)
        rows[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        auto& row = rows[i % 3];
        const auto& above = rows[(i + 2) % 3];
        const auto& above2 = rows[(i + 1) % 3];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
            const bool swapped =
                i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) row[j] = std::min(row[j], above2[j - 2] + 1);
        }
    }
    return rows[a.size() % 3][b.size()];
}

bool begins(std::string_view whole, std::string_view part)
{
    return part.size() >= 3 && whole.size() > part.size() &&
           std::equal(
               part.begin(), part.end(), whole.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

} // namespace

std::string shortened(std::string_view text, std::size_t bytes)
{
    if (text.size() <= bytes) return std::string(text);
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xc0) == 0x80)
        --bytes;
    return std::string(text.substr(0, bytes)) + "...";
}

// Source: Unicode 15, table 3-7.
bool is_utf8(std::string_view text)
{
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    for (std::size_t i = 0; i < text.size();) {
        const unsigned lead = byte(i), next = byte(i + 1);
        const std::size_t length = lead < 0x80 ? 1 : lead < 0xc2 ? 0 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
        if (length == 0 || lead > 0xf4) return false;
        for (std::size_t k = 1; k < length; ++k)
            if ((byte(i + k) & 0xc0) != 0x80) return false;
        const bool overlong = (lead == 0xe0 && next < 0xa0) || (lead == 0xf0 && next < 0x90);
        const bool beyond = (lead == 0xed && next >= 0xa0) || (lead == 0xf4 && next >= 0x90);
        if (overlong || beyond) return false;
        i += length;
    }
    return true;
}

std::string in_quotes(std::string_view text)
{
    return '"' + shortened(text, 60) + '"';
}

std::string listed(std::span<const std::string> words)
{
    if (words.empty()) return "none";
    constexpr std::size_t most = 20;
    std::string list;
    for (const std::string& word : words.first(std::min(words.size(), most)))
        list += (list.empty() ? "" : ", ") + shortened(word, 60);
    return words.size() > most ? list + ", ..." : list;
}

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> words)
{
    if (word.empty() || word.size() > kLongestWord) return std::nullopt;
    std::optional<std::string> best;
    std::size_t fewest = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string& candidate : words.first(std::min<std::size_t>(words.size(), 200))) {
        if (candidate.empty() || candidate.size() > kLongestWord) continue;
        const std::size_t slips =
            begins(candidate, word) || begins(word, candidate) ? 1 : typing_slips(word, candidate);
        if (slips >= fewest || slips >= candidate.size()) continue;
        fewest = slips;
        best = candidate;
    }
    return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> words)
{
    const std::optional<std::string> meant = nearest(word, words);
    return meant ? "; did you mean " + in_quotes(*meant) + "?" : std::string();
}

} // namespace api
