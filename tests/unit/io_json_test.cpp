// JSON text: escaping, order of keys, numbers that read back exactly, no NaN.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "io/json.hpp"

using polder::Json;

TEST_CASE("keys keep the order in which they were set and a second setting replaces the value") {
  Json json = Json::object();
  json["zulu"] = 1;
  json["alpha"]["inner"] = true;
  json["zulu"] = 2;
  json["list"].push_back(1.5);
  json["list"].push_back("two");
  json["none"] = Json();
  json["empty"] = Json::array();
  CHECK(json.text() ==
        "{\n  \"zulu\": 2,\n  \"alpha\": {\n    \"inner\": true\n  },\n  \"list\": [\n    1.5,\n    "
        "\"two\"\n  ],\n"
        "  \"none\": null,\n  \"empty\": []\n}\n");
}

TEST_CASE("text is escaped and stays valid UTF-8") {
  CHECK(Json("a\"b\\c\n\t\x01").text() == "\"a\\\"b\\\\c\\n\\t\\u0001\"\n");
  CHECK(Json("\xC3\xBC \xE2\x88\x9E \xF0\x9F\x8C\x8A").text() ==
        "\"\xC3\xBC \xE2\x88\x9E \xF0\x9F\x8C\x8A\"\n");
  CHECK(Json("\xFFx").text() == "\"\\ufffdx\"\n");
  CHECK(Json("\xE2\x88").text() == "\"\\ufffd\\ufffd\"\n");             // cut short
  CHECK(Json("\xC0\xAF").text() == "\"\\ufffd\\ufffd\"\n");             // overlong
  CHECK(Json("\xED\xA0\x80").text() == "\"\\ufffd\\ufffd\\ufffd\"\n");  // surrogate
}

TEST_CASE("numbers") {
  CHECK(Json(0.1).text() == "0.1\n");
  CHECK(std::stod(Json(1.0 / 3.0).text()) == 1.0 / 3.0);
  CHECK(Json(std::numeric_limits<double>::quiet_NaN()).text() == "null\n");
  CHECK(Json(-std::numeric_limits<double>::infinity()).text() == "null\n");
  CHECK(Json(std::numeric_limits<std::uint64_t>::max()).text() == "18446744073709551615\n");
  CHECK(Json(std::numeric_limits<std::int64_t>::min()).text() == "-9223372036854775808\n");
  CHECK(Json(std::size_t{7}).text() == "7\n");
}

TEST_CASE("an array does not take members and an object no items") {
  Json list = Json::array();
  CHECK_THROWS_AS(list["key"], std::logic_error);
  Json object = Json::object();
  CHECK_THROWS_AS(object.push_back(1), std::logic_error);
}
