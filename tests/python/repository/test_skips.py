"""The summary of skips that ends a run of the tests."""

import skips


def test_missing_tools_come_first_and_by_name():
    reasons = ["takes long", *["could not import 'heyoka': No module named 'heyoka'"] * 3, "needs g++ or clang++",
               "takes long", "no Chromium: apt install chromium", "this machine lacks a level"]
    lines = skips.summary(reasons)
    assert [line.split()[0] for line in lines] == ["3", "1", "1", "1", "2"]
    assert "MISSING heyoka" in lines[0] and any("MISSING g++ or clang++" in line for line in lines)
    assert any("MISSING Chromium" in line for line in lines) and lines[-1].endswith("2  takes long")
    assert skips.tool("taylor does not take the scene") is None
