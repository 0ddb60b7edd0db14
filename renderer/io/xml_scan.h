// XmlScan: walks XML text without building anything, to look at a hostile document before a library does.
//
// Takes    elements, attributes, text, comments, CDATA and the declaration. A document type is refused: what it
//          can define (entities that name one another, files) nobody needs in a mesh.
// Errors   next() gives `fault` once, then nothing more; what and where stand in fault_words(). Elements must
//          close in order; nesting is bounded.
// Cost     linear; memory for the names of open elements.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace renderer {

class XmlScan {
public:
    enum class Event { open, close, text, end, fault };

    explicit XmlScan(std::string_view text, std::size_t deepest = 512) : text_(text), deepest_(deepest) {}

    Event next();
    std::string_view name() const { return name_; }  // of the element that opened or closed, without a prefix
    std::string_view text() const { return value_; } // as it stands there
    // Of the element that opened; as it stands there.
    std::optional<std::string_view> attribute(std::string_view name) const;

    bool ended_early() const { return ended_early_; } // the fault is that the text ends
    std::size_t offset() const { return at_; }
    const std::string& fault_words() const { return fault_; }

private:
    struct Attribute {
        std::string_view name, value;
    };
    Event fail(const std::string& what);
    Event ends();
    bool skip_past(std::string_view mark);
    Event tag();
    Event closing_tag();
    Event attributes();
    void blanks();
    std::string_view take_name();

    std::string_view text_;
    std::size_t deepest_, at_ = 0;
    std::string_view name_, value_;
    std::vector<Attribute> attributes_;
    std::vector<std::string_view> open_;
    bool closes_at_once_ = false, ended_early_ = false, seen_root_ = false;
    std::string fault_;
};

} // namespace renderer
