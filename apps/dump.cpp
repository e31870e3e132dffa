#include "tenon/apps/dump.hpp"

#include <algorithm>
#include <stdexcept>

#include "tenon/apps/json.hpp"
#include "tenon/apps/result_json.hpp"
#include "tenon/core/input_error.hpp"
#include "tenon/core/output_file.hpp"
#include "tenon/core/read_file.hpp"
#include "tenon/core/solver.hpp"

namespace tenon {

namespace {

constexpr int kSchema = 1;
constexpr std::string_view kDigits = "0123456789abcdef";

bool is_plain_text(const std::string& bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [](char c) { return (c >= ' ' && c <= '~') || c == '\n' || c == '\r' || c == '\t'; });
}

std::string to_hex(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += {kDigits[byte >> 4], kDigits[byte & 15]};
  }
  return text;
}

std::string from_hex(const std::string& text) {
  std::string bytes;
  for (std::size_t k = 0; k + 1 < text.size() + text.size() % 2; k += 2) {
    const std::size_t high = kDigits.find(text[k]), low = kDigits.find(text[k + 1]);
    if (high > 15 || low > 15) throw std::invalid_argument("'nl_hex' is not hexadecimal");
    bytes += static_cast<char>(high * 16 + low);
  }
  return bytes;
}

Json point_json(const Point& point) {
  return Json::object().set("x", point.x).set("lambda", point.lambda).set("z", point.z);
}

Options read_options(const Json& json) {
  Options options;
  options.tolerance = json.at("tolerance").number();
  options.max_iterations = static_cast<int>(std::clamp(json.at("max_iterations").number(), 0.0, 1e9));
  if (!json.at("time_limit").is_null()) options.time_limit = json.at("time_limit").number();
  validate(options);
  return options;
}

}  // namespace

void write_dump(const std::string& path, const NamedProblem& named, const Options& options, const Measurement& m) {
  Json json = Json::object();
  json.set("schema", kSchema).set("problem", named.name);
  if (!named.built_in.empty())
    json.set("built_in", named.built_in);
  else if (is_plain_text(named.nl_bytes))
    json.set("nl", named.nl_bytes);
  else
    json.set("nl_hex", to_hex(named.nl_bytes));
  json.set("options", Json::object()
                          .set("tolerance", options.tolerance)
                          .set("max_iterations", options.max_iterations)
                          .set("time_limit", options.time_limit));
  json.set("start", point_json(named.start));
  json.set("solver", m.solver).set("status", to_string(m.result.status)).set("iterations", m.result.iterations);
  json.set("objective", m.result.objective).set("residual", residual_json(m.result.residual));
  set_explanation(json, *named.problem, m);
  json.set("point", point_json(m.point));
  OutputFile file(path);
  file.append(json.text());
  file.finish();
}

NamedProblem read_dump(const std::string& path) {
  const Json json = Json::parse(read_file(path), path, "an object as `tenon solve --dump` writes it");
  try {
    if (json.at("schema").number() != kSchema) throw std::invalid_argument("'schema' is not " + std::to_string(kSchema));
    const std::string name = json.at("problem").as_text();
    NamedProblem named;
    if (json.has("built_in"))
      named = built_in_problem(json.at("built_in").as_text());
    else
      named = nl_problem(json.has("nl") ? json.at("nl").as_text() : from_hex(json.at("nl_hex").as_text()), name);
    named.name = path;
    named.options = read_options(json.at("options"));
    const Json start = json.at("start");
    named.start.x = start.at("x").as_vector();
    named.start.lambda = start.at("lambda").as_vector();
    named.start.z = start.at("z").as_vector();
    validate(*named.problem, named.start);
    return named;
  } catch (const std::invalid_argument& error) {
    throw InputError({path, 0, 0}, error.what(), "a dump as `tenon solve --dump` writes it");
  } catch (const InputError& error) {
    throw InputError({path, 0, 0}, std::string("the problem within: ") + error.what());
  }
}

}  // namespace tenon
