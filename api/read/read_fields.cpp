#include "api/read/read_fields.h"

#include "api/json/pointer.h"
#include "api/words/limit_words.h"
#include "api/words/sentences.h"

#include <algorithm>

namespace api {

namespace {

// Members that are often written one floor too low or too high.
std::string misplaced(const std::string& pointer, std::string_view name)
{
    static constexpr std::array in_scene{
        "camera", "environment", "materials", "objects", "lights", "transport"};
    static constexpr std::array beside_scene{"image",
                                             "quality",
                                             "limits",
                                             "files",
                                             "seed",
                                             "priority",
                                             "labels",
                                             "fail_on",
                                             "acceleration",
                                             "provenance"};
    if (pointer.empty() && std::find(in_scene.begin(), in_scene.end(), name) != in_scene.end())
        return "; it stands in \"scene\"";
    if (pointer == "/scene" &&
        std::find(beside_scene.begin(), beside_scene.end(), name) != beside_scene.end())
        return "; it stands beside \"scene\", not in it";
    return {};
}

} // namespace

ReadFields::ReadFields(const Json& node, std::string pointer, ReadState& state)
    : node_(node.is_object() ? &node : nullptr), pointer_(std::move(pointer)), state_(state)
{
    if (!node_) wrong_type(pointer_, "an object", node);
}

void ReadFields::finish()
{
    if (!node_ || forgiving_) return;
    for (const auto& [name, value] : node_->items()) {
        if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
        std::string hint = misplaced(pointer_, name);
        if (hint.empty()) hint = did_you_mean(name, suggested_);
        if (hint.empty()) hint = "; there are: " + listed(suggested_);
        // Nobody looks for a name of a megabyte by a pointer of a megabyte.
        fault(at(shortened(name, kLongestName)),
              "unknown_member",
              "there is no member " + in_quotes(name) + " here" + hint);
    }
}

void ReadFields::boolean(const char* name, bool& value, const char*)
{
    const Json* node = find(name);
    if (!node) return;
    if (node->is_boolean())
        value = node->get<bool>();
    else
        wrong_type(at(name), "true or false", *node);
}

void ReadFields::unbuilt(std::initializer_list<const char*> names, const char* remedy)
{
    for (const char* name : names) {
        known_.push_back(name);
        if (node_ && node_->contains(name))
            fault(at(name), "unsupported", in_quotes(name) + " is not available in this build; " + remedy);
    }
}

void ReadFields::foreign(const char* name, const char* remedy)
{
    known_.push_back(name);
    if (node_ && node_->contains(name)) fault(at(name), "conflict", in_quotes(name) + ": " + remedy);
}

void ReadFields::needs(std::initializer_list<const char*> names)
{
    for (const char* name : names)
        if (node_ && !node_->contains(name))
            fault(at(name), "missing_member", in_quotes(name) + " must be given");
}

void ReadFields::exclude(const char* a, const char* b, const char* remedy)
{
    if (node_ && node_->contains(a) && node_->contains(b))
        fault(at(b),
              "exclusive_members",
              in_quotes(b) + " and " + in_quotes(a) + " exclude each other: " + remedy);
}

std::string ReadFields::at(std::string_view member) const
{
    return pointer_to(pointer_, member);
}

std::string ReadFields::at(std::string_view member, std::size_t index) const
{
    return pointer_to(at(member), index);
}

void ReadFields::fault(std::string pointer, const char* code, std::string detail)
{
    state_.faults.add(std::move(pointer), code, std::move(detail));
}

void ReadFields::wrong_type(std::string pointer, const char* expected, const Json& got)
{
    std::string detail = std::string("expected ") + expected + ", got " + type_words(got);
    if (got.is_null()) detail += ": for the default leave the member out";
    fault(std::move(pointer), "wrong_type", std::move(detail));
}

const Json* ReadFields::find(const char* name)
{
    known_.push_back(name);
    suggested_.emplace_back(name);
    if (!node_) return nullptr;
    const auto found = node_->find(name);
    return found == node_->end() ? nullptr : &*found;
}

const Json* ReadFields::array_of(const char* name, const char* limit)
{
    const Json* node = find(name);
    if (!node) return nullptr;
    if (!node->is_array()) {
        wrong_type(at(name), "an array", *node);
        return nullptr;
    }
    if (limit && node->size() > value_of(limit, state_.context.limits))
        state_.faults.add(over_limit(at(name), limit, node->size(), state_.context.limits));
    return node;
}

const Word* ReadFields::chosen(const char* name, WordTable words, const char* needed)
{
    const Json* node = find(name);
    if (!node) {
        if (needed && node_)
            fault(at(name),
                  "missing_member",
                  in_quotes(name) + " must be given, " + needed + ": " + listed(names_of(words)));
        return nullptr;
    }
    if (!node->is_string()) {
        wrong_type(at(name), "a string", *node);
        return nullptr;
    }
    return word_at(at(name), node->get_ref<const std::string&>(), words);
}

const Word* ReadFields::word_at(std::string pointer, const std::string& text, WordTable words)
{
    const std::vector<std::string> available = names_of(words);
    const Word* word = find_word(words, text);
    if (word && word->built()) return word;
    if (word)
        fault(std::move(pointer),
              "unsupported",
              in_quotes(text) + " is not available in this build; available: " + listed(available));
    else
        fault(std::move(pointer),
              "unknown_value",
              in_quotes(text) + " is none of " + listed(available) + did_you_mean(text, available));
    return nullptr;
}

const std::string* ReadFields::text(const char* name, std::size_t longest)
{
    const Json* node = find(name);
    return node ? text_at(*node, at(name), 1, longest) : nullptr;
}

const std::string*
ReadFields::text_at(const Json& node, const std::string& pointer, std::size_t shortest, std::size_t longest)
{
    if (!node.is_string()) {
        wrong_type(pointer, "a string", node);
        return nullptr;
    }
    const auto& text = node.get_ref<const std::string&>();
    if (text.size() >= shortest && text.size() <= longest) return &text;
    fault(pointer,
          "wrong_length",
          text.empty() ? "must not be empty"
                       : std::to_string(text.size()) + " bytes are more than " + std::to_string(longest));
    return nullptr;
}

bool ReadFields::name_fits(const std::string& pointer, const std::string& name)
{
    if (!name.empty() && name.size() <= kLongestName) return true;
    fault(pointer,
          "bad_name",
          name.empty() ? "a name must not be empty"
                       : "a name has at most " + std::to_string(kLongestName) + " bytes");
    return false;
}

} // namespace api
