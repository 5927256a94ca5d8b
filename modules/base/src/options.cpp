#include "drape/base/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "drape/base/numbers.hpp"

namespace drape {
namespace {

Option make(std::string_view name, std::string_view help, OptionKind kind) {
  return {std::string(name), std::string(help), kind, false, {}, 0, {}, {}, {}};
}

// Whole numbers are stored as std::int64_t, numbers as double, whatever the member's own type is.
template <class Stored, class Member>
void bind_value(Option& option, Member& member) {
  option.get = [&member]() -> OptionValue { return Stored(member); };
  option.assign = [&member](const OptionValue& value) {
    member = static_cast<Member>(std::get<Stored>(value));
  };
}

template <class Stored, class Member>
void bind_value(Option& option, std::optional<Member>& member) {
  option.may_be_unset = true;
  option.get = [&member]() -> OptionValue {
    if (!member) return std::monostate{};
    return Stored(*member);
  };
  option.assign = [&member](const OptionValue& value) {
    if (std::holds_alternative<std::monostate>(value))
      member.reset();
    else
      member = static_cast<Member>(std::get<Stored>(value));
  };
}

std::string range_text(const Range& range) {
  return fmt::format("{} and {}", format_number(range.least), format_number(range.most));
}

std::variant<OptionValue, std::string> parse_number(const Option& option, std::string_view text) {
  const std::optional<double> value = parse_double(text);
  if (!value || !std::isfinite(*value)) return fmt::format("is '{}'; must be a number", text);
  if (option.range && (*value < option.range->least || *value > option.range->most))
    return fmt::format("is {}; must be within {}", text, range_text(*option.range));
  if (option.kind != OptionKind::integer) return OptionValue(*value);
  if (*value != std::floor(*value)) return fmt::format("is {}; must be a whole number", text);
  return OptionValue(static_cast<std::int64_t>(*value));
}

}  // namespace

void Binder::flag(std::string_view name, bool& member, std::string_view help) {
  Option option = make(name, help, OptionKind::flag);
  bind_value<bool>(option, member);
  options_.push_back(std::move(option));
}

void Binder::number(std::string_view name, int& member, Range range, std::string_view help) {
  Option option = make(name, help, OptionKind::integer);
  option.range = range;
  bind_value<std::int64_t>(option, member);
  options_.push_back(std::move(option));
}

void Binder::number(std::string_view name, double& member, Range range, std::string_view help) {
  Option option = make(name, help, OptionKind::number);
  option.range = range;
  bind_value<double>(option, member);
  options_.push_back(std::move(option));
}

void Binder::number(std::string_view name, std::optional<int>& member, Range range, std::string_view help) {
  Option option = make(name, help, OptionKind::integer);
  option.range = range;
  bind_value<std::int64_t>(option, member);
  options_.push_back(std::move(option));
}

void Binder::number(std::string_view name, std::optional<double>& member, Range range,
                    std::string_view help) {
  Option option = make(name, help, OptionKind::number);
  option.range = range;
  bind_value<double>(option, member);
  options_.push_back(std::move(option));
}

void Binder::numbers(std::string_view name, std::vector<double>& member, std::size_t size, Range range,
                     std::string_view help) {
  Option option = make(name, help, OptionKind::numbers);
  option.range = range;
  option.list_size = size;
  bind_value<std::vector<double>>(option, member);
  options_.push_back(std::move(option));
}

void Binder::text(std::string_view name, std::string& member, std::string_view help) {
  Option option = make(name, help, OptionKind::text);
  bind_value<std::string>(option, member);
  options_.push_back(std::move(option));
}

std::variant<OptionValue, std::string> parse_option(const Option& option, std::string_view text) {
  if (option.may_be_unset && text == "auto") return OptionValue(std::monostate{});
  switch (option.kind) {
    case OptionKind::flag:
      if (text == "true") return OptionValue(true);
      if (text == "false") return OptionValue(false);
      return fmt::format("is '{}'; must be true or false", text);
    case OptionKind::integer:
    case OptionKind::number:
      return parse_number(option, text);
    case OptionKind::text:
      return OptionValue(std::string(text));
    case OptionKind::choice: {
      if (std::find(option.choices.begin(), option.choices.end(), text) != option.choices.end())
        return OptionValue(std::string(text));
      std::string words = fmt::format("is '{}'; must be one of {}", text, fmt::join(option.choices, ", "));
      const std::string guess = closest(text, option.choices);
      if (!guess.empty()) words += fmt::format("; did you mean {}?", guess);
      return words;
    }
    case OptionKind::numbers:
      return parse_option(option, std::vector<std::string>{std::string(text)});
  }
  return std::string("has an unknown kind");
}

std::variant<OptionValue, std::string> parse_option(const Option& option,
                                                    const std::vector<std::string>& texts) {
  if (option.kind != OptionKind::numbers) return std::string("is a list; must be a single value");
  if (option.list_size != 0 && texts.size() != option.list_size)
    return fmt::format("has {} values; must have {}", texts.size(), option.list_size);
  std::vector<double> values;
  for (const std::string& text : texts) {
    std::variant<OptionValue, std::string> value = parse_number(option, text);
    if (std::holds_alternative<std::string>(value)) return value;
    values.push_back(std::get<double>(std::get<OptionValue>(value)));
  }
  return OptionValue(std::move(values));
}

std::string readable(const OptionValue& value) {
  struct Visitor {
    std::string operator()(std::monostate) const { return "auto"; }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const { return format_number(number); }
    std::string operator()(const std::string& text) const { return text.empty() ? "\"\"" : text; }
    std::string operator()(const std::vector<double>& list) const {
      std::string text = "[";
      for (std::size_t i = 0; i < list.size(); ++i) text += (i == 0 ? "" : ", ") + format_number(list[i]);
      return text + "]";
    }
  };
  return std::visit(Visitor{}, value);
}

std::string canonical(const OptionValue& value) {
  struct Visitor {
    std::string operator()(std::monostate) const { return "unset"; }
    std::string operator()(bool flag) const { return flag ? "true" : "false"; }
    std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
    std::string operator()(double number) const { return fmt::format("{:a}", number); }
    std::string operator()(const std::string& text) const { return fmt::format("{}:{}", text.size(), text); }
    std::string operator()(const std::vector<double>& list) const {
      std::string text = fmt::format("{}", list.size());
      for (const double number : list) text += fmt::format(" {:a}", number);
      return text;
    }
  };
  return std::visit(Visitor{}, value);
}

std::string closest(std::string_view text, const std::vector<std::string>& names) {
  const auto distance = [](std::string_view a, std::string_view b) {
    // Optimal string alignment (Damerau-Levenshtein with adjacent swaps), three rows.
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), now(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
      now[0] = i;
      for (std::size_t j = 1; j <= b.size(); ++j) {
        now[j] = std::min({last[j] + 1, now[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
        if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
          now[j] = std::min(now[j], before[j - 2] + 1);
      }
      std::swap(before, last);
      std::swap(last, now);
    }
    return last[b.size()];
  };
  std::string best;
  std::size_t least = 4;
  for (const std::string& name : names) {
    const std::size_t d = distance(text, name);
    if (d < least && 2 * d < name.size()) {
      least = d;
      best = name;
    }
  }
  return best;
}

}  // namespace drape
