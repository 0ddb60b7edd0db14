#include "renderer/io/xml_scan.h"

#include "renderer/io/text.h"

namespace renderer {

namespace {

bool is_space(char c)
{
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

bool ends_name(char c)
{
    return is_space(c) || c == '/' || c == '>' || c == '=' || c == '<' || c == '"' || c == '\'';
}

std::string_view without_prefix(std::string_view name)
{
    const std::size_t colon = name.find(':');
    return colon == name.npos ? name : name.substr(colon + 1);
}

} // namespace

XmlScan::Event XmlScan::fail(const std::string& what)
{
    fault_ = "byte " + std::to_string(at_) + ": " + what;
    at_ = text_.size();
    open_.clear();
    return Event::fault;
}

XmlScan::Event XmlScan::ends()
{
    ended_early_ = true;
    return fail("the text ends there: send it whole");
}

bool XmlScan::skip_past(std::string_view mark)
{
    const std::size_t found = text_.find(mark, at_);
    if (found == text_.npos) return false;
    at_ = found + mark.size();
    return true;
}

void XmlScan::blanks()
{
    while (at_ < text_.size() && is_space(text_[at_]))
        ++at_;
}

std::string_view XmlScan::take_name()
{
    const std::size_t begin = at_;
    while (at_ < text_.size() && !ends_name(text_[at_]))
        ++at_;
    return text_.substr(begin, at_ - begin);
}

XmlScan::Event XmlScan::next()
{
    if (!fault_.empty()) return Event::end;
    if (closes_at_once_) {
        closes_at_once_ = false;
        name_ = without_prefix(open_.back());
        open_.pop_back();
        return Event::close;
    }
    while (true) {
        if (at_ == text_.size()) {
            if (!open_.empty() || !seen_root_) return ends();
            return Event::end;
        }
        if (text_[at_] != '<') {
            const std::size_t end = std::min(text_.find('<', at_), text_.size());
            value_ = text_.substr(at_, end - at_);
            at_ = end;
            if (!open_.empty()) return Event::text;
            for (const char c : value_)
                if (!is_space(c)) return fail("text outside of any element");
            continue;
        }
        const std::string_view rest = text_.substr(at_);
        if (rest.starts_with("<?")) {
            if (!skip_past("?>")) return ends();
        } else if (rest.starts_with("<!--")) {
            if (!skip_past("-->")) return ends();
        } else if (rest.starts_with("<![CDATA[")) {
            at_ += 9;
            const std::size_t begin = at_;
            if (!skip_past("]]>")) return ends();
            value_ = text_.substr(begin, at_ - 3 - begin);
            if (!open_.empty()) return Event::text;
        } else if (rest.starts_with("<!")) {
            return fail("a document type, which is not read: what it defines may be a bomb");
        } else {
            return tag();
        }
    }
}

XmlScan::Event XmlScan::closing_tag()
{
    at_ += 2;
    const std::string_view name = take_name();
    blanks();
    if (at_ == text_.size()) return ends();
    if (text_[at_] != '>' || open_.empty() || open_.back() != name)
        return fail("</" + clean_utf8(name, 40) + "> closes nothing that is open there");
    ++at_;
    open_.pop_back();
    name_ = without_prefix(name);
    return Event::close;
}

XmlScan::Event XmlScan::tag()
{
    if (text_.substr(at_).starts_with("</")) return closing_tag();
    ++at_;
    const std::string_view name = take_name();
    if (name.empty()) return at_ == text_.size() ? ends() : fail("an element without a name");
    if (open_.empty() && seen_root_) return fail("a second root element");
    if (open_.size() == deepest_) return fail("nested more than " + std::to_string(deepest_) + " deep");
    seen_root_ = true;
    open_.push_back(name);
    name_ = without_prefix(name);
    return attributes();
}

XmlScan::Event XmlScan::attributes()
{
    attributes_.clear();
    while (true) {
        blanks();
        if (at_ == text_.size()) return ends();
        if (text_[at_] == '>') {
            ++at_;
            return Event::open;
        }
        if (text_.substr(at_).starts_with("/>")) {
            at_ += 2;
            closes_at_once_ = true;
            return Event::open;
        }
        const std::string_view name = take_name();
        blanks();
        if (at_ == text_.size()) return ends();
        if (name.empty() || text_[at_] != '=') return fail("an attribute is not name=\"value\"");
        ++at_;
        blanks();
        if (at_ == text_.size()) return ends();
        const char quote = text_[at_++];
        if (quote != '"' && quote != '\'') return fail("an attribute's value is not quoted");
        const std::size_t end = text_.find(quote, at_);
        if (end == text_.npos) return ends();
        if (attribute(name)) return fail("attribute " + in_quotes(name) + " stands there twice");
        attributes_.push_back({name, text_.substr(at_, end - at_)});
        at_ = end + 1;
    }
}

std::optional<std::string_view> XmlScan::attribute(std::string_view name) const
{
    for (const Attribute& a : attributes_)
        if (a.name == name) return a.value;
    return std::nullopt;
}

} // namespace renderer
