// Pieces of sentences for faults: quoting what a client wrote, lists of words, and "did you mean".
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace api {

// At most `bytes` of the text, cut between characters, with "..." where it was cut.
std::string shortened(std::string_view text, std::size_t bytes);

// Well-formed UTF-8: no overlong forms, no surrogates, nothing beyond U+10FFFF.
bool is_utf8(std::string_view text);

// "text" in double quotes, shortened to what a sentence bears.
std::string in_quotes(std::string_view text);

// "a, b, c"; the first twenty and "..." of a long list; "none" of an empty one.
std::string listed(std::span<const std::string> words);

// The word that was likely meant: few typing slips away, or one is the beginning of the other.
// Looks at the first 200 words only, whoever wrote them.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> words);

// "; did you mean \"x\"?" or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string> words);

} // namespace api
