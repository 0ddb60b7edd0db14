#include "renderer/io/read_fbx.h"

#include "renderer/io/assimp_scene.h"
#include "renderer/io/fbx_models.h"
#include "renderer/io/text.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace renderer {

namespace {

// The identifier after a comma or a colon; nothing if there is none.
std::optional<std::int64_t> take_identifier(std::string_view& rest)
{
    rest = trimmed(rest);
    const std::size_t end = rest.find_first_not_of("-0123456789");
    const auto value = parse_integer(rest.substr(0, end));
    rest.remove_prefix(std::min(end, rest.size()));
    rest = trimmed(rest);
    if (rest.starts_with(',')) rest.remove_prefix(1);
    return value;
}

// Texts are not looked into: what stands between quotes is none of the structure.
std::string without_texts(std::string_view line)
{
    std::string plain;
    bool inside = false;
    for (const char c : line) {
        if (c == '"')
            inside = !inside;
        else if (!inside && c == ';')
            break;
        else if (!inside)
            plain += c;
    }
    return plain;
}

} // namespace

// Line by line, as every writer lays it out: braces, what arrays promise, models and their connections.
std::optional<ImportFault> check_text_fbx(std::string_view text)
{
    constexpr int kDeepest = 64;
    FbxModels models;
    int level = 0;
    Lines lines(text);
    while (const auto line = lines.next()) {
        const auto fault = [&](std::string code, const std::string& what) {
            return ImportFault{std::move(code),
                               "line " + std::to_string(lines.number()) + " of the FBX: " + what};
        };
        const std::string plain = line->size() < 4096 ? without_texts(*line) : std::string();
        for (const char c : plain) {
            level += c == '{' ? 1 : c == '}' ? -1 : 0;
            if (level > kDeepest) return fault("malformed", "nested more than 64 deep");
            if (level < 0) return fault("malformed", "a brace closes what is not open");
        }
        std::string_view rest = plain;
        const std::string_view word = take_word(rest);
        if (const std::size_t star = rest.find('*'); star != rest.npos) {
            std::string_view number = rest.substr(star + 1);
            const auto count = take_identifier(number);
            if (!count || *count < 0 || static_cast<std::uint64_t>(*count) > text.size() / 2)
                return fault("truncated", "an array promises more values than the file can hold");
        }
        if (word == "Model:")
            if (const auto id = take_identifier(rest)) models.add_model(*id);
        if (word == "C:" && line->find("\"OO\"") != line->npos) {
            rest = trimmed(rest);
            if (rest.starts_with(',')) rest.remove_prefix(1);
            const auto child = take_identifier(rest), parent = take_identifier(rest);
            if (child && parent) models.connect(*child, *parent);
        }
    }
    if (level != 0)
        return ImportFault{
            "truncated", "the FBX ends with " + std::to_string(level) + " braces open: send the file whole"};
    return models.check();
}

ImportResult read_fbx(std::span<const std::byte> bytes, CompanionFiles& files, const Limits& limits)
{
    const std::string_view text = text_of(bytes);
    auto bad = text.starts_with("Kaydara FBX Binary") ? check_binary_fbx(text, limits) : check_text_fbx(text);
    if (bad) return std::move(*bad);
    return read_with_assimp(
        {.format = "fbx", .importer = "Autodesk FBX", .title = "FBX"}, bytes, files, limits);
}

} // namespace renderer
