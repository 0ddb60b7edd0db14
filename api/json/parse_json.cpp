#include "api/json/parse_json.h"

#include "api/json/pointer.h"
#include "api/words/limit_words.h"
#include "api/words/sentences.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace api {

namespace {

// Walks the text and tells how far the parser has read: its events carry no position.
class CountingIterator {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++()
    {
        *furthest_ = ++at_;
        return *this;
    }
    CountingIterator operator++(int)
    {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }

private:
    const char* at_;
    const char** furthest_;
};

// The library's sentence without its name, numbers and the text that it quotes at length.
std::string plain_words(std::string_view what)
{
    for (const std::string_view mark :
         {std::string_view("while parsing"), std::string_view("number overflow")})
        if (const std::size_t at = what.find(mark); at != std::string_view::npos) {
            std::string words = shortened(what.substr(at), 200);
            if (const std::size_t dash = words.find(" - "); dash != std::string::npos)
                words.replace(dash, 3, ": ");
            return words;
        }
    return "this is not JSON";
}

class BoundedBuilder final : public nlohmann::json_sax<Json> {
public:
    explicit BoundedBuilder(const renderer::Limits& limits) : limits_(limits) {}

    bool null() override { return put(nullptr); }
    bool boolean(bool value) override { return put(value); }
    bool number_integer(std::int64_t value) override { return put(value); }
    bool number_unsigned(std::uint64_t value) override { return put(value); }
    bool number_float(double value, const std::string&) override { return put(value); }
    bool string(std::string& value) override { return put(std::move(value)); }
    bool binary(Json::binary_t&) override { return refuse("syntax", "binary values are not JSON"); }
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }

    bool key(std::string& name) override
    {
        const bool twice = open_.back().container->contains(name);
        open_.back().key = std::move(name);
        in_member_ = true;
        if (twice)
            return refuse("duplicate_member",
                          in_quotes(open_.back().key) + " stands twice in one object: keep one of them");
        return true;
    }

    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& error) override
    {
        std::string words = plain_words(error.what());
        if (words.find("number overflow") != std::string::npos)
            return refuse("not_finite", words + ": JSON numbers must stay below 1.8e308");
        if (words.find("UTF-8") != std::string::npos)
            return refuse("not_utf8",
                          words.substr(0, words.find("; last read")) + ": send the text as UTF-8");
        if (words.find("invalid literal") != std::string::npos)
            words +=
                "; a value is a number, a string in double quotes, true, false, null, an array or an object "
                "(there is no NaN and no Infinity in JSON)";
        return refuse("syntax", words);
    }

    Json take() { return std::move(root_); }
    [[nodiscard]] const Problem& fault() const { return fault_; }

private:
    struct Open {
        Json* container;
        std::string key; // of the member that is being read, in an object
    };

    template <typename Value>
    bool put(Value&& value)
    {
        return place(Json(std::forward<Value>(value))) != nullptr;
    }

    bool open(Json container)
    {
        if (open_.size() >= limits_.json_depth)
            return refuse("too_deep",
                          "nested deeper than the limit json_depth, " + std::to_string(limits_.json_depth) +
                              "; " + raise_words("json_depth"));
        Json* placed = place(std::move(container));
        if (!placed) return false;
        open_.push_back({placed, {}});
        return true;
    }

    bool close()
    {
        open_.pop_back();
        return true;
    }

    // Where the value now stands; nothing if there are too many.
    Json* place(Json value)
    {
        if (++count_ > limits_.json_values) {
            refuse("too_many_values",
                   "more values than the limit json_values, " + std::to_string(limits_.json_values) + "; " +
                       raise_words("json_values"));
            return nullptr;
        }
        in_member_ = false;
        if (open_.empty()) return &(root_ = std::move(value));
        Json& container = *open_.back().container;
        if (container.is_array()) {
            container.push_back(std::move(value));
            return &container.back();
        }
        return &(container[open_.back().key] = std::move(value));
    }

    bool refuse(const char* code, std::string detail)
    {
        std::string pointer;
        for (const Open& open : open_) {
            const bool innermost = &open == &open_.back();
            if (open.container->is_array())
                pointer = pointer_to(pointer, open.container->size() - (innermost ? 0 : 1));
            else if (!innermost || in_member_)
                pointer = pointer_to(pointer, open.key);
            if (pointer.size() > 1000) break; // as deep as anyone reads
        }
        fault_ = {std::move(pointer), code, std::move(detail)};
        return false;
    }

    const renderer::Limits& limits_;
    Json root_;
    std::vector<Open> open_;
    std::uint64_t count_ = 0;
    bool in_member_ = false; // its name is read, its value is not
    Problem fault_;
};

// "line 3, column 7": counted in bytes, from 1, of the last byte read.
std::string place_words(std::string_view text, std::size_t read)
{
    const std::string_view before = text.substr(0, read > 0 ? read - 1 : 0);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(before.size() - start + 1);
}

} // namespace

std::variant<Json, ProblemDetails> parse_json(std::string_view text, const renderer::Limits& limits)
{
    if (text.size() > limits.json_bytes)
        return problem_from_faults(413, "over_limit", {over_limit("", "json_bytes", text.size(), limits)});
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        return problem_from_faults(
            400,
            "malformed_json",
            {{"", "syntax", R"(the body is empty; it must be a JSON object such as {"scene": {...}})"}});
    BoundedBuilder builder(limits);
    const char* furthest = text.data();
    const CountingIterator first(text.data(), &furthest), last(text.data() + text.size(), &furthest);
    if (Json::sax_parse(first, last, &builder)) return builder.take();
    Problem fault = builder.fault();
    fault.detail = place_words(text, static_cast<std::size_t>(furthest - text.data())) + ": " + fault.detail;
    return problem_from_faults(400, "malformed_json", {std::move(fault)});
}

} // namespace api
