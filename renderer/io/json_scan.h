// JsonScan: walks JSON text without building anything, to look at a hostile document before a library does.
//
// Errors  everything returns false after the first fault; fault_offset() says where. Strict RFC 8259, nesting
//         bounded.
// Cost    linear, no allocation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>

namespace renderer {

class JsonScan {
public:
    explicit JsonScan(std::string_view text, int deepest = 64) : text_(text), levels_left_(deepest) {}

    // Calls `member` with each key, unescaped only if it needs no unescaping (else it is empty); it must
    // consume the value by one of these functions and return what that returned.
    bool object(const std::function<bool(std::string_view key)>& member);
    bool array(const std::function<bool()>& element);
    bool string(std::string_view& out); // as it stands between the quotes, escapes and all
    bool index(std::uint32_t& out);     // a whole number that is not negative
    bool skip();                        // any value
    bool at_end();                      // nothing but blanks left

    std::size_t fault_offset() const { return at_; }
    bool too_deep() const { return too_deep_; }

private:
    void blanks();
    bool take(char c);
    bool peek(char c);
    bool number();
    bool word(std::string_view expected);
    bool enter();

    std::string_view text_;
    std::size_t at_ = 0;
    int levels_left_;
    bool too_deep_ = false;
};

} // namespace renderer
