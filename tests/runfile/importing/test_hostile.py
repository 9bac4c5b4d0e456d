"""Files that are damaged, mislabelled or made to hurt: one sentence each, nothing on stderr, nothing written."""

from __future__ import annotations

import builtins
import logging
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from rig.runfile.extra import how_to_install
from rig.runfile.importing import READERS
from tests.some import some

from .conftest import Foreign
from .formats import MAPPING, WRITERS, columns, write_csv

FIRST = ["run.csv", "run.parquet", "run.mat", "run.h5", "run.mf4", "run.tdms"]


@pytest.mark.parametrize("suffix", READERS)
def test_an_empty_file(foreign: Foreign, suffix: str) -> None:
    assert foreign.refused(foreign.bytes(b"", f"x{suffix}")).startswith(f"x{suffix} is empty (0 bytes)")


@pytest.mark.parametrize("suffix", READERS)
def test_binary_junk(foreign: Foreign, suffix: str) -> None:
    junk = np.random.default_rng(4).bytes(3000)
    said = foreign.refused(foreign.bytes(junk, f"x{suffix}"))
    assert "(3000 bytes) is not a" in said or "is not text: byte" in said or "is not utf-8 text: byte" in said


@pytest.mark.parametrize("suffix", READERS)
def test_a_file_that_is_absent(foreign: Foreign, suffix: str) -> None:
    assert "No such file or directory" in foreign.refused(foreign.folder / f"x{suffix}")


def test_a_folder_and_a_suffix_nobody_reads(foreign: Foreign) -> None:
    (foreign.folder / "x.csv").mkdir()
    assert "x.csv is a folder; expected a file ending in one of .csv" in foreign.refused(foreign.folder / "x.csv")
    said = foreign.refused(foreign.bytes(b"x", "x.xlsx"))
    assert said == f"x.xlsx: suffix '.xlsx' cannot be imported; expected one of {', '.join(READERS)}"


@pytest.mark.parametrize("name", [n for n in WRITERS if n != "run.csv"])
@pytest.mark.parametrize("other", [".csv", ".parquet", ".mat", ".h5", ".mf4", ".tdms"])
def test_a_file_under_another_suffix_is_recognised(foreign: Foreign, name: str, other: str) -> None:
    content = foreign.file(name=name).read_bytes()
    if Path(name).suffix == other:
        return
    said = foreign.refused(foreign.bytes(content, f"y{other}"))
    assert "as its suffix says: it is " in said
    assert f"expected the suffix {Path(name).suffix}" in said


def test_text_in_a_file_that_is_none_is_nothing_that_a_dialect_would_mend(foreign: Foreign) -> None:
    made: dict[str, Any] = dict(columns())
    made["time"] = [f"{x:.3f}".replace(".", ",") for x in made["time"]]
    path = foreign.folder / "run.parquet"
    pq.write_table(pa.table(made), path)
    said = foreign.refused(path)
    assert "run.parquet: column 'time' holds text: row 1 holds '5000,000'; expected whole numbers or floats" in said
    assert "[csv]" not in said


@pytest.mark.slow
@pytest.mark.parametrize("name", [n for n in WRITERS if n != "run.csv"])
@pytest.mark.parametrize("share", some([0.03, 0.6, 0.999], 1))
def test_a_file_cut_short(
    foreign: Foreign, name: str, share: float, caplog: pytest.LogCaptureFixture, capfd: Any
) -> None:
    content = foreign.file(name=name).read_bytes()
    with caplog.at_level(logging.DEBUG):
        said = foreign.refused(foreign.bytes(content[: int(len(content) * share)], name))
    assert "damaged or cut short" in said or "has no column" in said or "not equally long" in said, said
    assert not caplog.records
    assert capfd.readouterr() == ("", "")


@pytest.mark.slow
@pytest.mark.parametrize("name", FIRST)
@pytest.mark.parametrize("seed", some(range(4), 1))
def test_flipped_bytes_end_in_a_run_or_a_sentence(foreign: Foreign, name: str, seed: int) -> None:
    from rig.core.errors import UsageError
    from rig.runfile.importing import import_file

    rng = np.random.default_rng(seed)
    content = bytearray(foreign.file(name=name).read_bytes())
    for at in rng.integers(0, len(content), 20):
        content[at] = rng.integers(0, 256)
    path = foreign.bytes(bytes(content), name)
    try:
        import_file(path, foreign.mapping(MAPPING), foreign.out)
    except UsageError as refusal:
        assert "\n" not in str(refusal)
        assert not foreign.out.exists()


def test_a_csv_with_one_column_because_of_the_delimiter(foreign: Foreign) -> None:
    path = foreign.folder / "run.csv"
    write_csv(path, columns(), delimiter=";")
    assert foreign.refused(path) == (
        "run.csv has 1 column when split at ',', but its header holds ';' 4 times; set [csv] delimiter = \";\""
    )


def test_a_csv_with_one_column_in_truth(foreign: Foreign) -> None:
    assert "has no column 'time'; there is a" in foreign.refused(foreign.bytes(b"a\n1\n2\n"))


def test_a_csv_in_another_encoding(foreign: Foreign) -> None:
    text = "time,motor,load,torque,temperature,Prüfling\n1,2,3,4,5,ä\n"
    said = foreign.refused(foreign.bytes(text.encode("cp1252")))
    assert said == "run.csv is not utf-8 text: byte 37 cannot be read; set [csv] encoding, e.g. 'cp1252'"
    said = foreign.refused(foreign.bytes(text.encode()), MAPPING + '[csv]\nencoding = "klingon"\n')
    assert "csv.encoding = 'klingon' is no encoding" in said


@pytest.mark.parametrize(("encoding", "byte"), [("utf-16", 3), ("utf-16-le", 1), ("utf-16-be", 0)])
def test_utf16_is_named_where_nobody_said_so(foreign: Foreign, encoding: str, byte: int) -> None:
    said = foreign.refused(foreign.bytes("time,motor\n1,2\n".encode(encoding)))
    assert f"is not text: byte {byte} is 0" in said
    assert said.endswith(f'; it looks like UTF-16: set [csv] encoding = "{encoding}"')


def test_zeros_alone_are_no_utf16(foreign: Foreign) -> None:
    assert foreign.refused(foreign.bytes(bytes(64))).endswith("is not text: byte 0 is 0 (csv.encoding = 'utf-8')")


def test_a_binary_file_is_no_utf16(foreign: Foreign) -> None:
    said = foreign.refused(foreign.bytes(b"\x7fELF\x02\x01\x01" + bytes(9) + b"\x03\x00>\x00\x01" + bytes(range(256))))
    assert said == "run.csv is not text: byte 7 is 0 (csv.encoding = 'utf-8')"


def test_lines_before_the_header_are_found_and_how_many(foreign: Foreign) -> None:
    path = foreign.file()
    path.write_text(f"Logger 3\nrig: north; 20 °C\n\n{path.read_text()}")
    said = foreign.refused(path)
    assert said == (
        "run.csv: line 1 is read as the header, but line 4 holds the names of the columns; set [csv] skip_rows = 3"
    )
    assert foreign.imported(path, MAPPING + "[csv]\nskip_rows = 3\n").rows == 400


@pytest.mark.parametrize("before", [0, 2])
@pytest.mark.parametrize("bad", ["{t},2", "{t},2,3,x,5"])
def test_a_bad_row_has_one_number_whoever_finds_it(foreign: Foreign, before: int, bad: str) -> None:
    path = foreign.file()
    lines = ["a logger's line"] * before + path.read_text().splitlines()
    lines[before + 250] = bad.format(t=lines[before + 250].partition(",")[0])
    path.write_text("\n".join(lines) + "\n")
    said = foreign.refused(path, MAPPING + f"[csv]\nskip_rows = {before}\n")
    assert "row 250 " in said, said
    assert "Row #" not in said


def test_utf16_and_a_byte_order_mark_are_read(foreign: Foreign) -> None:
    path = foreign.folder / "run.csv"
    write_csv(path, columns(), encoding="utf-16")
    assert foreign.imported(path, MAPPING + '[csv]\nencoding = "utf-16"\n').rows == 400
    write_csv(path, columns(), encoding="utf-8-sig")
    assert foreign.imported(path).rows == 400


@pytest.mark.parametrize("decimal", [".", ","])
def test_decimals_of_two_kinds_are_told_with_row_and_value(foreign: Foreign, decimal: str) -> None:
    path = foreign.folder / "run.csv"
    write_csv(path, columns(), delimiter=";", decimal=decimal)
    lines = path.read_text().splitlines(keepends=True)
    lines[3] = lines[3].replace(decimal, ",."[decimal == ","])
    path.write_text("".join(lines))
    said = foreign.refused(path, MAPPING + f'[csv]\ndelimiter = ";"\ndecimal = "{decimal}"\n')
    assert f"column 'time' is not numbers: row 1 holds '5000{decimal}0' and row 3 holds '" in said
    assert "object" not in said


def test_decimal_commas_that_were_not_declared(foreign: Foreign) -> None:
    path = foreign.folder / "run.csv"
    write_csv(path, columns(), delimiter=";", decimal=",")
    said = foreign.refused(path, MAPPING + '[csv]\ndelimiter = ";"\n')
    assert "column 'time' is not numbers: row 1 holds '5000,0'; set [csv] decimal = \",\"" in said


@pytest.mark.slow
def test_a_row_with_a_cell_too_few(foreign: Foreign) -> None:
    path = foreign.file()
    lines = path.read_text().splitlines()
    lines[100] = lines[100].rpartition(",")[0]
    path.write_text("\n".join(lines))
    assert "Expected 5 columns, got 4" in foreign.refused(path)


@pytest.mark.parametrize("cut", [1, 2], ids=["the line end alone", "a digit too"])
def test_a_csv_cut_within_its_last_number_is_noted_and_keeps_its_row(foreign: Foreign, cut: int) -> None:
    """Many loggers end no last line: what may be whole is not thrown away."""
    path = foreign.file()
    data = path.read_bytes()
    path.write_bytes(data[:-cut])
    run, rows = foreign.imported(path), data.count(b"\n") - 1
    assert run.rows == rows
    said = f"row {rows}, the last, has no line end: the file may be cut short in its last number"
    assert said in run.manifest["notes"]


@pytest.mark.slow
def test_a_header_of_many_megabytes(foreign: Foreign) -> None:
    said = foreign.refused(foreign.bytes(b"a" * (3 << 20) + b"\n1\n2\n"))
    assert said == "run.csv: line 1 is longer than 1048576 characters; expected a table"
    said = foreign.refused(foreign.bytes(b'"' + b"a" * 200_000 + b'",b\n1,2\n'))
    assert "damaged or cut short and cannot be read as CSV: header: field larger than field limit" in said


@pytest.mark.slow
def test_a_table_of_many_thousand_columns_is_only_a_table(foreign: Foreign) -> None:
    data = columns() | {f"spare_{i}": np.zeros(400, dtype=np.int64) for i in range(3000)}
    assert foreign.imported(foreign.file(data)).rows == 400


def test_a_header_alone_and_no_header(foreign: Foreign) -> None:
    assert "0 rows of data" in foreign.refused(foreign.bytes(b"time,motor,load,torque,temperature\n"))
    assert "line 1 is empty or past the end" in foreign.refused(foreign.bytes(b"\n\n\n"))
    said = foreign.refused(foreign.file(), MAPPING + "[csv]\nskip_rows = 9000\n")
    assert "line 9001 is empty or past the end; expected the header (see csv.skip_rows)" in said


def test_matlab_objects_texts_and_structs(foreign: Foreign) -> None:
    from scipy.io import savemat

    data = columns()
    path = foreign.folder / "run.mat"
    savemat(path, {"log": data, "title": "rig", "cell": np.array([1, "a"], dtype=object), "M": np.ones((400, 3))})
    mapping = MAPPING
    for name in data:
        mapping = mapping.replace(f'column = "{name}"', f'column = "log.{name}"')
    assert foreign.imported(path, mapping).rows == 400
    mapping = mapping.replace('column = "log.temperature"', 'column = "M[3]"')
    assert set(foreign.imported(path, mapping).need("temperature")) == {1.0}


def test_hdf5_tables_and_matrices(foreign: Foreign) -> None:
    import h5py

    data = columns()
    path = foreign.folder / "run.h5"
    table = np.rec.fromarrays(list(data.values()), names=list(data))
    with h5py.File(path, "w") as file:
        file["log/table"] = table
        file["log/matrix"] = np.column_stack(list(data.values()))
        file["title"] = "rig"
    for pattern, names in (("table.{}", list(data)), ("log/matrix[{}]", range(5))):
        mapping = MAPPING
        for column, name in zip(data, names, strict=True):
            mapping = mapping.replace(f'column = "{column}"', f'column = "{pattern.format(name)}"')
        assert foreign.imported(path, mapping).rows == 400


def test_a_channel_name_that_stands_in_two_groups(foreign: Foreign) -> None:
    from nptdms import ChannelObject, TdmsWriter

    path = foreign.folder / "run.tdms"
    with TdmsWriter(path) as file:
        file.write_segment([ChannelObject(g, n, v) for g in ("fast", "slow") for n, v in columns().items()])
    said = foreign.refused(path)
    assert said == "run.tdms: column 'time' stands in 2 places; expected one of fast/time, slow/time"
    mapping = MAPPING.replace('column = "', 'column = "slow/')
    assert foreign.imported(path, mapping).rows == 400


@pytest.mark.slow
@pytest.mark.parametrize(("name", "package"), [("run.h5", "h5py"), ("run.mf4", "asammdf"), ("run.tdms", "nptdms")])
def test_an_optional_package_that_is_absent(
    foreign: Foreign, name: str, package: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = foreign.file(name=name)
    real = builtins.__import__

    def without(module: str, *args: Any, **kwargs: Any) -> Any:
        if module.partition(".")[0] == package:
            raise ModuleNotFoundError(f"No module named '{package}'", name=package)
        return real(module, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", without)
    said = foreign.refused(path)
    assert said.endswith(f"needs the package {package}, which is not installed; {how_to_install()}")


@pytest.mark.parametrize("decimal", [".", ","])
def test_text_far_down_is_blamed_by_its_own_row_and_no_setting_is_advised_that_is_made(
    foreign: Foreign, decimal: str
) -> None:
    path = foreign.folder / "run.csv"
    write_csv(path, columns(), delimiter=";", decimal=decimal)
    lines = path.read_text().splitlines(keepends=True)
    lines[301] = ";".join([*lines[301].split(";")[:3], "overflow", *lines[301].split(";")[4:]])
    path.write_text("".join(lines))
    said = foreign.refused(path, MAPPING + f'[csv]\ndelimiter = ";"\ndecimal = "{decimal}"\n')
    assert said == "run.csv: column 'torque' is not numbers: row 301 holds 'overflow'"
