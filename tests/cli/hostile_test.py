"""Inputs that would harm: docs/security.md. No file makes the program wait, connect, run code or fill the memory, and no
name in one reaches a page as markup or the terminal as a command."""
import contextlib
import csv
import html.parser
import http.server
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import threading
import time
import unittest
import xml.dom.minidom
import zipfile

from osgeo import gdal, ogr

from support import NORTH, TALUS, WEST, Case, box, system, write_features

SOUTH = NORTH - 300.0
ELM = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../data/elm")
DEEP = 100_000


class Scenario(Case):
    """A scenario whose inputs are replaced one by one."""

    def scenario(self, extra="", dem="dem.tif", sources="sources.gpkg", **keys):
        include = f'include = "{keys["include"]}"\n' if "include" in keys else ""
        return self.write("s.toml", f'dem = "{dem}"\n{include}[sources]\nfile = "{sources}"\n'
                          f"[blocks]\ndiameter = 0.8\n[output]\ntrajectories = 2\n{extra}")

    def run_arguments(self, *extra):
        return ["run", self.path("s.toml"), "-o", self.path("out"), "-q", *extra]

    def refused(self, *words, arguments=None, **options):
        options.setdefault("timeout", 60)
        self.fails(2, *words, arguments=arguments or self.run_arguments(), **options)
        self.assertFalse(os.path.exists(self.path("out")))


class SpecialFiles(Scenario):
    """Pipes, devices, sockets and folders in the place of a file: refused at once, never waited for."""

    def setUp(self):
        super().setUp()
        os.mkfifo(self.path("pipe"))
        for end in (".tif", ".gpkg", ".csv", ".toml", ".geojson"):
            os.symlink("pipe", self.path("pipe" + end))

    def test_as_a_text(self):
        pipe = self.path("pipe.toml")
        self.refused("is a pipe", "TOML", arguments=["run", pipe, "-o", self.path("out")])
        self.refused("is a pipe", arguments=["profile", pipe, "-o", self.path("out")])
        self.refused("is a pipe", arguments=["diagnose", pipe, "-o", self.path("out")])
        self.refused("is a pipe", arguments=["score", os.path.join(ELM, "campaign.toml"), "--parameters", pipe])
        self.refused("is a device", arguments=["run", "/dev/zero", "-o", self.path("out")])
        self.refused("is a folder", arguments=["run", self.folder, "-o", self.path("out")])
        self.scenario(include="pipe.toml")
        self.refused("is a pipe")

    def test_as_a_raster_or_a_layer(self):
        for name in ("pipe.tif", "/dev/zero"):
            self.scenario(dem=name)
            self.refused("dem = ", "must be a regular file")
        for name in ("pipe.gpkg", "pipe.csv", "pipe.geojson", "/dev/zero"):
            self.scenario(sources=name)
            self.refused("sources.file = ", "must be a regular file")
        for key in ("ground", "screens", "barriers"):
            self.scenario(f'[{key}]\nfile = "pipe.gpkg"\n')
            self.refused(f"{key}.file = ", "is a pipe")
        self.refused("is a pipe", arguments=["sources", "--dem", self.path("pipe.tif"), "-o", self.path("out.gpkg")])
        self.scenario()
        self.refused("flag --dem", "is a pipe", arguments=self.run_arguments("--dem", self.path("pipe")))

    def test_sockets_and_folders(self):
        with socket.socket(socket.AF_UNIX) as end:
            end.bind(self.path("socket.tif"))
            self.scenario(dem="socket.tif")
            self.refused("is a socket")
        os.mkdir(self.path("folder"))
        for keys in ({"dem": "folder"}, {"sources": "folder"}):
            self.scenario(**keys)
            self.refused("is a folder", "name a file in it")

    def test_beside_a_raster(self):
        for beside in ("dem.tif.aux.xml", "dem.tfw", "dem.tif.ovr", "dem.tif.msk"):
            os.symlink("pipe", self.path(beside))
            self.scenario()
            self.refused(beside, "is a pipe")
            os.remove(self.path(beside))

    def test_named_beside_a_raster(self):
        """GDAL opens the overviews and the mask that it finds, whatever they name (gdal.org, GDALDefaultOverviews)."""
        pipe, name = self.path("pipe"), '<Metadata domain="OVERVIEWS"><MDI key="OVERVIEW_FILE">{}</MDI></Metadata>'
        beside = self.write("dem.tif.aux.xml", f"<PAMDataset>{name.format(pipe)}</PAMDataset>")
        self.scenario()
        self.refused("dem.tif.aux.xml: names '" + pipe, "must name no other file")
        shutil.copy(self.path("dem.tif"), self.path("tile.tif"))
        os.rename(beside, self.path("tile.tif.aux.xml"))
        self.write("dem.vrt", VRT.format(srs="EPSG:2056", band=BAND.format(source="tile.tif", relative=1)))
        self.scenario(dem="dem.vrt")
        self.refused("tile.tif.aux.xml: names '" + pipe)
        self.scenario()
        for end in (".ovr", ".msk"):
            for source in (pipe, "/etc/passwd"):
                self.write("dem.tif" + end, VRT.format(srs="EPSG:2056", band=BAND.format(source=source, relative=0)))
                self.refused("dem.tif" + end + ": names", source)
            os.remove(self.path("dem.tif" + end))
        dem = gdal.Open(self.path("dem.tif"), gdal.GA_Update)
        dem.SetMetadataItem("OVERVIEW_FILE", pipe, "OVERVIEWS")  # in the file itself
        dem = None
        self.assertFalse(os.path.exists(beside))
        self.refused("dem.tif: names '" + pipe, "gdal_translate")

    def test_as_a_system_of_coordinates(self):
        shutil.copytree(ELM, self.path("campaign"))
        self.write("dem.prj", system(2056).ExportToWkt())
        for name in ("pipe", "dem.prj"):
            with open(os.path.join(ELM, "campaign.toml"), encoding="utf-8") as file:
                self.write("campaign/campaign.toml", f'crs = "{self.path(name)}"\n' + re.sub("(?m)^crs = .*$", "", file.read()))
            self.refused("is no coordinate system", name,
                         arguments=["diagnose", self.path("campaign/campaign.toml"), "-o", self.path("out")])

    def test_as_a_table(self):
        os.mkdir(self.path("campaign"))
        for name in os.listdir(ELM):
            shutil.copy(os.path.join(ELM, name), self.path("campaign"))
        for table in ("blocks", "stops", "passages", "screens"):
            file = self.path(f"campaign/{table}.csv")
            os.rename(file, file + ".kept")
            os.symlink("../pipe", file)
            self.refused(table, "is a pipe", arguments=["diagnose", self.path("campaign/campaign.toml"), "-o",
                                                        self.path("out")])
            os.rename(file + ".kept", file)
        self.write("p.toml", 'profile = "pipe.csv"\n[sources]\nx = 1\n[blocks]\ndiameter = 1\n')
        self.refused("is a pipe", arguments=["profile", self.path("p.toml"), "-o", self.path("out")])

    def test_in_a_folder_of_results(self):
        os.mkdir(self.path("run"))
        for name in ("run.json", "screens.csv", "part.json", "scenario.toml", "hazard_tally.gz"):
            os.symlink("../pipe", self.path("run/" + name))
        self.refused("is a pipe", arguments=["barrier", self.path("run"), "--screen", "a"])
        self.refused("is a pipe", arguments=["hazard", self.path("run")])
        self.refused("is a pipe", arguments=["merge", self.path("out"), self.path("run")])
        os.remove(self.path("run/run.json"))
        self.write("run/run.json", json.dumps({
            "released": 10, "effects": [], "grid": {"cell_x_m": 5.0}, "screens": [{"id": "a", "lines": [[[0, 0], [1, 1]]]}],
            "settings": [{"key": "blocks.density", "value": 2500}]}))
        self.refused("is a pipe", arguments=["barrier", self.path("run"), "--screen", "a"])

    def test_links_to_regular_files_are_followed(self):
        os.symlink("dem.tif", self.path("link.tif"))
        os.symlink("sources.gpkg", self.path("link.gpkg"))
        self.scenario(dem="link.tif", sources="link.gpkg")
        os.symlink("s.toml", self.path("link.toml"))
        self.run_well("run", self.path("link.toml"), "-o", self.path("out"), "-q")


class Sizes(Scenario):
    def test_keys_and_tables_in_one_another(self):
        for text in (".".join(["a"] * DEEP) + " = 1\n", "[" + ".".join(["a"] * DEEP) + "]\n",
                     "a = " + "[" * DEEP + "]" * DEEP + "\n", "a = " + "{a=" * DEEP + "1" + "}" * DEEP + "\n",
                     "a = {" + ".".join(["'a'"] * DEEP) + " = 1}\n"):
            self.write("s.toml", "# a comment\n" + text)
            self.refused("s.toml:2: ", "16 deep")
        self.write("s.toml", 'a = "' + "[" * 99 + '.' * 99 + '" # ' + "{" * 99 + "\nb = '''" + "\n[." * 99 + "'''\n")
        self.refused("unknown key")  # in strings and comments they are text

    def test_long_keys(self):
        self.write("s.toml", "a" * 3_000_000 + " = 1\n")
        begun = time.monotonic()
        self.refused("s.toml:1: key 'aaaa", "has 3000000 letters, must have at most 200")
        self.write("s.toml", 'surface = "' + "a" * 3_000_000 + '"\n')
        self.refused("surface = 'aaaa", "must be")
        self.assertLess(time.monotonic() - begun, 20.0)

    def test_large_texts(self):
        self.write("s.toml", "a" * 10_000_000 + " = 1\n")
        self.refused("has 9 MB, must have at most 4 MB")
        with open(self.path("s.toml"), "wb") as file:
            file.truncate(1 << 40)  # a hole of 1 TB
        self.refused("must have at most 4 MB")
        self.write("p.toml", 'profile = "p.csv"\n[sources]\nx = 1\n[blocks]\ndiameter = 1\n')
        with open(self.path("p.csv"), "wb") as file:
            file.truncate(1 << 40)
        self.refused("must have at most 2048 MB", arguments=["profile", self.path("p.toml"), "-o", self.path("out")])


class Listener:
    """A server on this machine that counts who connects. `answer`: 404 at once; without it, it never says a word."""

    def __init__(self, answer=True):
        self.count, self.answer, self.open = 0, answer, []
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        threading.Thread(target=self.serve, daemon=True).start()

    def serve(self):
        with contextlib.suppress(OSError):
            while True:
                connection, _ = self.socket.accept()
                self.count += 1
                if self.answer:
                    with contextlib.suppress(OSError):
                        connection.sendall(b"HTTP/1.1 404 Not Found\r\nContent-Length: 0\r\nConnection: close\r\n\r\n")
                    connection.close()
                else:
                    self.open.append(connection)

    def close(self):
        self.socket.close()
        for connection in self.open:
            connection.close()


VRT = ("<VRTDataset rasterXSize='60' rasterYSize='60'><SRS>{srs}</SRS><GeoTransform>2600000, 5, 0, 1200300, 0, -5"
       "</GeoTransform>{band}</VRTDataset>")
BAND = ("<VRTRasterBand dataType='Float32' band='1'><SimpleSource><SourceFilename relativeToVRT='{relative}'>{source}"
        "</SourceFilename><SourceBand>1</SourceBand></SimpleSource></VRTRasterBand>")
PYTHON = ("<VRTRasterBand dataType='Float32' band='1' subClass='VRTDerivedRasterBand'><PixelFunctionType>f"
          "</PixelFunctionType><PixelFunctionLanguage>Python</PixelFunctionLanguage><PixelFunctionCode><![CDATA[\n"
          "def f(in_ar, out_ar, *args, **kwargs):\n    open('{marker}', 'w').close()\n    out_ar[:] = in_ar[0]\n]]>"
          "</PixelFunctionCode><SimpleSource><SourceFilename relativeToVRT='1'>dem.tif</SourceFilename></SimpleSource>"
          "</VRTRasterBand>")


class Network(Scenario):
    """Whatever a file names: no connection."""

    def setUp(self):
        super().setUp()
        self.listener = Listener()
        self.addCleanup(self.listener.close)
        self.web = f"http://127.0.0.1:{self.listener.port}"

    def vrt(self, source, relative=0, srs="EPSG:2056", name="dem.vrt", band=BAND):
        self.write(name, VRT.format(srs=srs, band=band.format(source=source, relative=relative)))
        return name

    def silent(self, *words, code=2, arguments=None, **options):
        options.setdefault("timeout", 60)
        self.listener.count = 0
        done = self.call(*(arguments or self.run_arguments()), **options)
        self.assertEqual(self.listener.count, 0, done.stderr)
        self.assertEqual(done.returncode, code, done.stderr)
        for word in words:
            self.assertIn(word, done.stderr)
        shutil.rmtree(self.path("out"), True)

    def names(self):
        return (f"{self.web}/dem.tif", f"/vsicurl/{self.web}/dem.tif", f"/vsicurl?url={self.web}/dem.tif",
                f"/vsicurl_streaming/{self.web}/dem.tif", f"/vsizip//vsicurl/{self.web}/a.zip/dem.tif",
                f"/vsizip/vsicurl/{self.web}/a.zip/dem.tif", f"/vsigzip//vsicurl/{self.web}/dem.tif",
                f"/vsisubfile/0_10,/vsicurl/{self.web}/dem.tif", f"/vsicached?file=/vsicurl/{self.web}/dem.tif",
                f"GTIFF_DIR:1:/vsicurl/{self.web}/dem.tif", f"NETCDF:{self.web}/dem.nc:height",
                f"WMS:{self.web}/wms", f"WMTS:{self.web}/wmts", f"WCS:{self.web}/wcs", f"WFS:{self.web}/wfs",
                f"OAPIF:{self.web}/api", f"GeoJSON:{self.web}/a.geojson", f"ESRIJSON:{self.web}/a.json",
                f"PG:host=127.0.0.1 port={self.listener.port} user=a dbname=a connect_timeout=2",
                f"MYSQL:a,host=127.0.0.1,port={self.listener.port}", f"ZARR:/vsicurl/{self.web}/a.zarr",
                f"CSW:{self.web}/csw", f"<GDAL_WMS><Service name='WMS'><ServerUrl>{self.web}</ServerUrl></Service>"
                "</GDAL_WMS>", f"file://{self.web}", f"/vsis3/bucket/dem.tif")

    def test_names(self):
        environment = {**os.environ, "AWS_S3_ENDPOINT": self.web[7:], "AWS_HTTPS": "NO", "AWS_VIRTUAL_HOSTING": "NO",
                       "AWS_NO_SIGN_REQUEST": "YES"}
        for name in self.names():
            with self.subTest(name):
                self.scenario(dem=name)
                self.silent("dem = ", "must be", env=environment)
                self.scenario(sources=name)
                self.silent("sources.file = ", "must be", env=environment)
        self.scenario(dem=f"{self.web}/dem.tif")
        self.silent("is an address, must be a local file: download it first, or give --allow-network")
        self.scenario(sources=f"PG:host=127.0.0.1 port={self.listener.port}")
        self.silent("databases and services are not read")

    def test_every_key(self):
        name = f"/vsicurl/{self.web}/a.gpkg"
        self.scenario(include=name)
        self.silent("a.gpkg")
        for key in ("ground", "screens", "barriers"):
            self.scenario(f'[{key}]\nfile = "{name}"\n')
            self.silent(f"{key}.file = ", "--allow-network")
        self.scenario()
        for flag in ("--dem", "--sources"):
            self.silent(f"flag {flag}", "--allow-network", arguments=self.run_arguments(flag, name))
        self.silent("--allow-network", arguments=["check", self.path("s.toml"), "--dem", name])
        self.silent("--allow-network", arguments=["sources", "--dem", name, "-o", self.path("cliffs.gpkg")])
        self.write("p.toml", f'dem = "{name}"\nline = "{name}"\n[sources]\nx = 1\n[blocks]\ndiameter = 1\n')
        self.silent("--allow-network", arguments=["profile", self.path("p.toml"), "-o", self.path("out")])
        campaign = self.read_text(os.path.join(ELM, "campaign.toml")).replace('dem = "dem.tif"', f'dem = "{name}"')
        self.write("campaign.toml", re.sub(r'"(\w+\.(csv|tif))"', rf'"{ELM}/\1"', campaign))
        self.silent("--allow-network", arguments=["diagnose", self.path("campaign.toml"), "-o", self.path("out")])

    def test_in_a_vrt(self):
        for name in self.names():
            with self.subTest(name):
                self.scenario(dem=self.vrt(name.replace("&", "&amp;").replace("<", "&lt;")))
                self.silent("dem.vrt", "names '")
        self.vrt(f"/vsicurl/{self.web}/dem.tif", name="inner.vrt")
        self.scenario(dem=self.vrt("inner.vrt", 1))
        self.silent("inner.vrt: names '/vsicurl/")

    def test_files_that_are_texts_with_addresses(self):
        ogr_vrt = self.write("ogr.vrt", "<OGRVRTDataSource><OGRVRTLayer name='a'><SrcDataSource>PG:host=127.0.0.1 port="
                             f"{self.listener.port}</SrcDataSource></OGRVRTLayer></OGRVRTDataSource>")
        wms = self.write("wms.xml", f"<GDAL_WMS><Service name='WMS'><ServerUrl>{self.web}/wms?</ServerUrl><Layers>a"
                         "</Layers></Service><DataWindow><UpperLeftX>0</UpperLeftX><UpperLeftY>9</UpperLeftY><LowerRightX>9"
                         "</LowerRightX><LowerRightY>0</LowerRightY><SizeX>90</SizeX><SizeY>90</SizeY></DataWindow>"
                         "</GDAL_WMS>")
        wcs = self.write("wcs.xml", f"<WCS_GDAL><ServiceURL>{self.web}/wcs?</ServiceURL><CoverageName>a</CoverageName>"
                         "</WCS_GDAL>")
        wfs = self.write("wfs.xml", f"<OGRWFSDataSource><URL>{self.web}/wfs</URL></OGRWFSDataSource>")
        for name in (ogr_vrt, wms, wcs, wfs):
            self.scenario(dem=name)
            self.silent("cannot be opened as a raster", "docs/security.md")
            self.scenario(sources=name)
            self.silent("cannot be opened as a vector layer", "docs/security.md")

    def test_systems_of_coordinates(self):
        """A system given by an address is fetched by GDAL: in a VRT and in a GeoJSON."""
        self.scenario(dem=self.vrt("dem.tif", 1, srs=f"{self.web}/crs.wkt"))
        self.silent("dem.vrt")
        self.write("a.geojson", json.dumps({
            "type": "FeatureCollection", "crs": {"type": "link", "properties": {"href": f"{self.web}/crs", "type": "wkt"}},
            "features": [{"type": "Feature", "properties": {}, "geometry": {
                "type": "Point", "coordinates": [WEST + 150.0, SOUTH + 235.0]}}]}))
        self.scenario(sources="a.geojson")
        self.call(*self.run_arguments())
        self.assertEqual(self.listener.count, 0)

    def test_grids_of_proj(self):
        """PROJ fetches grids of a transformation where the environment says so."""
        self.scenario(sources="old.geojson")
        self.write("old.geojson", json.dumps({
            "type": "FeatureCollection", "crs": {"type": "name", "properties": {"name": "EPSG:21781"}},
            "features": [{"type": "Feature", "properties": {}, "geometry": {
                "type": "Point", "coordinates": [600150.0, 200235.0]}}]}))
        environment = {**os.environ, "PROJ_NETWORK": "ON", "PROJ_NETWORK_ENDPOINT": self.web,
                       "PROJ_USER_WRITABLE_DIRECTORY": self.folder}
        self.call(*self.run_arguments(), env=environment)
        self.assertEqual(self.listener.count, 0)

    def test_overviews_and_masks_named_in_metadata(self):
        dem = gdal.Open(self.path("dem.tif"), gdal.GA_Update)
        dem.SetMetadataItem("OVERVIEW_FILE", f"/vsicurl/{self.web}/dem.ovr", "OVERVIEWS")
        dem = None
        self.scenario()
        self.silent("OVERVIEW_FILE", "must name no other file")

    def test_python_in_a_vrt(self):
        marker = self.path("python_ran")
        self.scenario(dem=self.vrt("", band=PYTHON.replace("{marker}", marker)))
        for value in ("YES", "TRUSTED_MODULES"):
            self.silent("dem.vrt", "Python, which is never run",
                        env={**os.environ, "GDAL_VRT_ENABLE_PYTHON": value, "GDAL_VRT_TRUSTED_MODULES": "*"})
            self.assertFalse(os.path.exists(marker))

    def test_a_hanging_server_and_signals(self):
        """With the network allowed a server can be waited for: signals end that too."""
        listener = Listener(answer=False)
        self.addCleanup(listener.close)
        self.scenario(dem=f"http://127.0.0.1:{listener.port}/dem.tif")
        for kind in (signal.SIGTERM, signal.SIGINT):
            for arguments in (self.run_arguments("--allow-network"), ["check", self.path("s.toml"), "--allow-network"]):
                seen = listener.count
                process = subprocess.Popen([TALUS, *arguments], stderr=subprocess.PIPE, text=True)
                end = time.monotonic() + 30.0
                while listener.count == seen and time.monotonic() < end:
                    time.sleep(0.02)
                process.send_signal(kind)
                begun = time.monotonic()
                message = process.communicate(timeout=30)[1]
                self.assertLess(time.monotonic() - begun, 5.0)
                self.assertEqual((process.returncode, message), (130, "talus: interrupted; nothing was written\n"))
        self.assertEqual([f for f in os.listdir(self.folder) if "talus" in f], [])


class Ranges(http.server.SimpleHTTPRequestHandler):
    """Files of a folder, with ranges of bytes."""

    def do_GET(self):
        path = self.translate_path(self.path)
        wanted = re.fullmatch(r"bytes=(\d+)-(\d*)", self.headers.get("Range", ""))
        if not wanted or not os.path.isfile(path):
            super().do_GET()
            return
        with open(path, "rb") as file:
            data = file.read()
        first, last = int(wanted[1]), min(int(wanted[2] or len(data)), len(data) - 1)
        self.send_response(206)
        self.send_header("Content-Range", f"bytes {first}-{last}/{len(data)}")
        self.send_header("Content-Length", str(last - first + 1))
        self.send_header("Accept-Ranges", "bytes")
        self.end_headers()
        self.wfile.write(data[first:last + 1])

    def log_message(self, *words):
        self.server.asked.append(words)


class AllowNetwork(Scenario):
    def test_a_cloud_optimised_dem(self):
        self.scenario()
        self.run_well(*self.run_arguments())
        self.assertNotIn("network", self.record())
        os.rename(self.path("out"), self.path("local"))
        gdal.Translate(self.path("cog.tif"), self.path("dem.tif"), format="COG")
        server = http.server.ThreadingHTTPServer(
            ("127.0.0.1", 0), lambda *words: Ranges(*words, directory=self.folder))
        server.asked = []
        threading.Thread(target=server.serve_forever, daemon=True).start()
        self.addCleanup(server.server_close)
        self.addCleanup(server.shutdown)
        web = f"http://127.0.0.1:{server.server_port}"
        self.write("dem.vrt", VRT.format(srs="EPSG:2056", band=BAND.format(
            source=f"/vsicurl/{web}/cog.tif", relative=0)))
        for name in (f"{web}/cog.tif", f"/vsicurl/{web}/cog.tif", "dem.vrt"):
            self.scenario(dem=name)
            server.asked.clear()
            self.refused("--allow-network")
            self.assertEqual(server.asked, [])
            self.run_well(*self.run_arguments("--allow-network"))
            self.assertGreater(len(server.asked), 0)
            record = self.record()
            self.assertEqual(record["network"], "allowed")
            self.assertEqual([len(i["sha256"]) for i in record["inputs"]], [64, 64, 64])
            for map_name in ("impact_probability.tif", "energy.tif"):
                with open(self.path("out/" + map_name), "rb") as ours, open(self.path("local/" + map_name), "rb") as other:
                    self.assertEqual(ours.read(), other.read())
            shutil.rmtree(self.path("out"))
        self.scenario(dem=f"{web}/cog.tif", sources=f"{web}/sources.gpkg")
        self.run_well("check", self.path("s.toml"), "--allow-network")
        self.scenario(dem=f"{web}/nowhere.tif")
        self.refused("no such file", arguments=self.run_arguments("--allow-network"))
        self.scenario(dem="PG:dbname=a")
        self.refused("databases and services", arguments=self.run_arguments("--allow-network"))


class LocalNames(Scenario):
    """What a VRT may name, and names of parts of files."""

    def setUp(self):
        super().setUp()
        os.makedirs(self.path("project/tiles"))
        os.mkdir(self.path("elsewhere"))
        shutil.copy(self.path("dem.tif"), self.path("elsewhere/dem.tif"))
        os.rename(self.path("dem.tif"), self.path("project/tiles/dem.tif"))

    def vrt(self, name, source, relative):
        self.write(name, VRT.format(srs="EPSG:2056", band=BAND.format(source=source, relative=relative)))

    def test_where_a_vrt_looks(self):
        self.scenario(dem="project/dem.vrt")
        for source, relative in (("tiles/dem.tif", 1), (self.path("project/tiles/dem.tif"), 0)):
            self.vrt("project/dem.vrt", source, relative)  # below its own folder
            self.run_well(*self.run_arguments())
            shutil.rmtree(self.path("out"))
        self.vrt("project/dem.vrt", "../elsewhere/dem.tif", 1)  # below the scenario's
        self.run_well(*self.run_arguments())
        shutil.rmtree(self.path("out"))
        arguments = ["run", "--dem", self.path("project/dem.vrt"), "--sources", self.path("sources.gpkg"), "--diameter",
                     "1", "-q", "-o", self.path("out")]
        for source, relative in (("../elsewhere/dem.tif", 1), (self.path("elsewhere/dem.tif"), 0)):
            self.vrt("project/dem.vrt", source, relative)  # below neither
            self.refused("project/dem.vrt: names " + self.path("elsewhere/dem.tif"), "--allow-folder " +
                         self.path("elsewhere"), arguments=arguments)
            self.run_well(*arguments, "--allow-folder", self.path("elsewhere"))
            shutil.rmtree(self.path("out"))
        os.symlink("../elsewhere/dem.tif", self.path("project/link.tif"))  # the user's own link is followed
        self.vrt("project/dem.vrt", "link.tif", 1)
        self.run_well(*arguments)

    def test_a_run_on_a_vrt_can_be_repeated_from_its_own_scenario(self):
        self.vrt("project/dem.vrt", "../elsewhere/dem.tif", 1)
        run = self.path("run.toml")
        with open(run, "w", encoding="utf-8") as file:
            file.write(f'dem = "project/dem.vrt"\ntrajectories = 2\n[sources]\nfile = "{self.path("sources.gpkg")}"\n[blocks]\ndiameter = 1\n')
        os.makedirs(self.path("far"))
        out = self.path("far/out")
        self.run_well("run", run, "-q", "-o", out)
        self.run_well("trace", out + "/scenario.toml", "--source", "0", "--block", "0")
        for part in "1", "2":
            self.run_well("run", run, "-q", "--part", part + "/2", "-o", self.path("far/part" + part))
        self.run_well("merge", self.path("far/merged"), self.path("far/part1"), self.path("far/part2"))
        self.run_well("check", "--allow-folder", self.path("far"), run)  # the flag before the scenario

    def test_a_vrt_behind_a_link_is_looked_at(self):
        os.mkdir(self.path("project/sub"))
        self.vrt("project/sub/inner.vrt", self.path("elsewhere/dem.tif"), 0)
        self.vrt("project/sub/real.vrt", "inner.vrt", 1)
        os.symlink("sub/real.vrt", self.path("project/dem.vrt"))
        arguments = ["run", "--dem", self.path("project/dem.vrt"), "--sources", self.path("sources.gpkg"), "--diameter",
                     "1", "-q", "-o", self.path("out")]
        self.refused("names " + self.path("elsewhere/dem.tif"), "--allow-folder", arguments=arguments)
        with zipfile.ZipFile(self.path("project/a.zip"), "w") as archive:
            archive.write(self.path("project/sub/inner.vrt"), "inner.vrt")
            archive.write(self.path("project/sub/real.vrt"), "real.vrt")
        arguments[2] = "/vsizip/" + self.path("project/a.zip/real.vrt")  # two slashes: an absolute path
        self.refused("names " + self.path("elsewhere/dem.tif"), arguments=arguments)

    def test_vrts_in_vrts(self):
        self.scenario(dem="project/dem.vrt")
        self.vrt("project/dem.vrt", "inner.vrt", 1)
        self.vrt("project/inner.vrt", "tiles/dem.tif", 1)
        self.run_well(*self.run_arguments())
        shutil.rmtree(self.path("out"))
        self.vrt("project/inner.vrt", "/etc/passwd", 0)
        self.refused("inner.vrt: names /etc/passwd")
        os.mkfifo(self.path("project/pipe.tif"))
        self.vrt("project/inner.vrt", "pipe.tif", 1)
        self.refused("inner.vrt: names 'pipe.tif', which is a pipe")
        for i in range(30):
            self.vrt(f"project/{i}.vrt", f"{i + 1}.vrt", 1)
        self.vrt("project/inner.vrt", "0.vrt", 1)
        self.refused("more than 8 deep")
        self.vrt("project/inner.vrt", "dem.vrt", 1)  # itself
        self.assertEqual(self.call(*self.run_arguments(), timeout=60).returncode, 2)

    def test_raw_bands_and_warped_vrts(self):
        self.scenario(dem="project/dem.vrt")
        for band in ("<VRTRasterBand dataType='Byte' band='1' subClass='VRTRawRasterBand'><SourceFilename "
                     "relativetoVRT='0'>/etc/passwd</SourceFilename></VRTRasterBand>",
                     "<VRTRasterBand dataType='Float32' band='1' subClass='VRTWarpedRasterBand'/><GDALWarpOptions>"
                     "<SourceDataset relativeToVRT='0'>/etc/passwd</SourceDataset></GDALWarpOptions>",
                     "<VRTRasterBand dataType='Float32' band='1'><SimpleSource SourceFilename='/etc/passwd'/>"
                     "</VRTRasterBand>",
                     *(f"<Metadata domain='{domain}'><MDI key='{key}'>/etc/passwd</MDI></Metadata><VRTRasterBand "
                       "dataType='Float32' band='1'/>"
                       for domain, key in (("GEOLOCATION", "X_DATASET"), ("GEOLOCATION", "Y_DATASET"),
                                           ("OVERVIEWS", "OVERVIEW_FILE")))):
            self.write("project/dem.vrt", VRT.format(srs="EPSG:2056", band=band))
            self.refused("names /etc/passwd")

    def test_open_options_of_a_vrt(self):
        """SQL before a GeoPackage is read could write files (VACUUM INTO); another root would move relative names."""
        gdal.Translate(self.path("project/dem.gpkg"), self.path("elsewhere/dem.tif"), format="GPKG")
        self.scenario(dem="project/dem.vrt")
        for option, value in (("PRELUDE_STATEMENTS", f"VACUUM INTO '{self.path('made.db')}'"), ("root_path", "/etc")):
            band = BAND.replace("</SourceFilename>", f'</SourceFilename><OpenOptions><OOI key="{option}">{value}</OOI></OpenOptions>')
            self.write("project/dem.vrt", VRT.format(srs="EPSG:2056", band=band.format(source="dem.gpkg", relative=1)))
            self.refused("dem.vrt: has the open option " + option)
        self.assertFalse(os.path.exists(self.path("made.db")))

    def test_an_archive_of_several_files(self):
        """GDAL's own words for it stay off the screen."""
        gdal.VectorTranslate(self.path("s.shp"), self.path("sources.gpkg"), format="ESRI Shapefile")
        with zipfile.ZipFile(self.path("s.shp.zip"), "w") as archive:
            for end in ("shp", "shx", "dbf", "prj"):
                archive.write(self.path("s." + end), "s." + end)
        done = self.call("check", "--dem", self.path("elsewhere/dem.tif"), "--sources", "/vsizip/" + self.path("s.shp.zip"),
                         "--diameter", "1")
        self.assertNotIn("ERROR", done.stderr)
        self.assertTrue(all(line.startswith("talus: ") for line in done.stderr.splitlines()), done.stderr)

    def test_archives_and_parts(self):
        with zipfile.ZipFile(self.path("a.zip"), "w") as archive:
            archive.write(self.path("elsewhere/dem.tif"), "inside/dem.tif")
        for name in (f"/vsizip/{self.path('a.zip')}/inside/dem.tif", f"/vsizip/{{{self.path('a.zip')}}}/inside/dem.tif",
                     f"GTIFF_DIR:1:{self.path('elsewhere/dem.tif')}"):
            self.scenario(dem=name)
            self.run_well(*self.run_arguments())
            shutil.rmtree(self.path("out"))
        os.mkfifo(self.path("pipe.zip"))
        self.scenario(dem=f"/vsizip/{self.path('pipe.zip')}/dem.tif")
        self.refused("is a pipe")
        self.scenario(dem=f"/vsizip/{self.path('nowhere.zip')}/dem.tif")
        self.refused("no such file")
        self.scenario(dem="file://" + self.path("elsewhere/dem.tif"))
        self.refused("leave out file://")
        for name in ("/vsistdin/", "/vsimem/a.tif", "MEM:::DATAPOINTER=1,PIXELS=9,LINES=9", "/vsisubfile/0_9,/etc/passwd"):
            self.scenario(dem=name)
            self.refused("dem = ", "must be")


HOSTILE = "<script>alert(1)</script>&amp;'\"\x1b[31m\u202e</svg>"


class Tags(html.parser.HTMLParser):
    """The elements and attributes of a page, and its text."""

    def __init__(self, page):
        super().__init__(convert_charrefs=True)
        self.elements, self.attributes, self.text = set(), set(), ""
        self.feed(page)

    def handle_starttag(self, tag, attributes):
        self.elements.add(tag)
        self.attributes |= {name for name, _ in attributes}

    def handle_data(self, data):
        self.text += data


class Names(Scenario):
    """Names of the input in pages and on the terminal."""

    def assert_tame(self, text):
        self.assertNotRegex(text, "[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")

    def hostile(self, what):
        return f"{what}{HOSTILE}"

    def campaign(self, name="campaign"):
        """Blocks that roll a few metres, with hostile names of everything."""
        os.mkdir(self.path(name))
        blocks, stops, passages = [], [], []
        for i in range(12):
            x, y, block = WEST + 60 + 10 * i, NORTH - 190, self.hostile(f"b{i:02}")
            blocks.append([block, x, y, 1, 400 + 60 * i, self.hostile(f"G{i % 2}"), int(i % 4 == 3)])
            stops.append([block, x + i % 3 - 1, y - 20 - i % 5])
            passages.append([block, self.hostile("S1"), 3 + 0.1 * i, 0.3 + 0.02 * i])
        line = f"LINESTRING ({WEST} {NORTH - 195}, {WEST + 300} {NORTH - 195})"
        for table, head, rows in (("blocks", "id,x,y,release_height_m,mass_kg,group,holdout", blocks), ("stops", "id,x,y", stops),
                                  ("passages", "id,screen,speed_ms,jump_height_m", passages),
                                  ("screens", "id,wkt", [[self.hostile("S1"), line]])):
            with open(self.path(f"{name}/{table}.csv"), "w", encoding="utf-8", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows([head.split(","), *rows])
        gdal.Translate(self.path(name + "/zones.tif"), self.path("dem.tif"), outputType=gdal.GDT_Byte,
                       scaleParams=[[0, 1e4, 1, 1]])
        tables = "".join(f'{table} = "{table}.csv"\n' for table in ("blocks", "stops", "passages", "screens"))
        return self.write(name + "/campaign.toml", f"name = {json.dumps(self.hostile('slope'))}\n{tables}"
                          f'dem = "../dem.tif"\nzones = "zones.tif"\n[zone_names]\n1 = {json.dumps(self.hostile("talus"))}\n'
                          "[measurement_error]\nposition_m = 0.3\nspeed_fraction = 0.03\njump_height_m = 0.1\n")

    def assert_page(self, path, whole=True):
        page = self.read_text(path)
        tags = Tags(page)
        self.assertNotIn("script", tags.elements)
        self.assertLessEqual(tags.elements, {"html", "head", "meta", "title", "style", "body", "h1", "h2", "h3", "p", "b", "br",
                                             "table", "tr", "td", "th", "header", "footer", "svg", "rect", "line", "circle", "text"})
        self.assertFalse({name for name in tags.attributes if name.startswith("on") or name in ("href", "src")})
        if whole:
            self.assertIn("<script>alert(1)</script>", tags.text)  # the name as it was given
        self.assertNotIn("&amp;lt;", page)  # escaped once
        self.assert_tame(page)
        return tags.text

    def test_the_pages_of_campaigns(self):
        campaign = self.campaign()
        common = ("--trials", "10", "--test-trials", "10", "--most-effects", "1", "--fit", "En50", "--threads", "2")
        done = self.run_well("diagnose", campaign, "-o", self.path("d"), *common, "--base-fits", "1", "--no-nested",
                             timeout=600)
        self.assert_tame(done.stdout + done.stderr)
        text = self.assert_page(self.path("d/report.html"))
        for word in ("slope<script>", "S1<script>"):
            self.assertIn(word, text)
        self.read_json("d/diagnosis.json")
        other = self.campaign("other")
        done = self.run_well("diagnose", campaign, other, "-o", self.path("dd"), *common, timeout=600)
        self.assert_tame(done.stdout + done.stderr)
        self.assert_page(self.path("dd/report.html"), whole=False)  # sites are called by names of folders
        done = self.run_well("calibrate", campaign, "-o", self.path("c"), "--trials", "20", "--fit", "En50", "--starts", "1")
        self.assert_tame(done.stdout + done.stderr)
        report = self.read_text("c/report.md")
        self.assertIn("# Calibration on slope&lt;script>", report)
        self.assertNotRegex(report, "<[a-z/!?]")
        self.assert_tame(report)
        self.assertIn("talus<script>", self.read_text("d/fitted.toml"))
        done = self.run_well("score", campaign, "--parameters", self.path("d/fitted.toml"))
        self.assert_tame(done.stdout + done.stderr)

    def test_the_drawing_of_a_profile(self):
        self.write("p.csv", "x,z\n0,100\n50,60\n100,20\n150,20\n")
        self.write("p.toml", 'profile = "p.csv"\n[sources]\nx = 5\n[blocks]\ndiameter = 1\n[screens]\nx = [60]\n'
                   f"[ground.zones.{json.dumps(HOSTILE)}]\npreset = \"forest-road-2d\"\nx = [20, 40]\n")
        done = self.run_well("profile", self.path("p.toml"), "-o", self.path("out"), "--trajectories", "5")
        self.assert_tame(done.stdout + done.stderr)
        xml.dom.minidom.parse(self.path("out/profile.svg"))

    def test_the_terminal(self):
        write_features(self.path("screens.gpkg"), "screens", [
            (f"LINESTRING ({WEST + 20} {SOUTH + 90},{WEST + 280} {SOUTH + 90})", [HOSTILE])], [("id", ogr.OFTString)])
        write_features(self.path("ground.gpkg"), "ground", [(box(0, 0, 300, 150), [HOSTILE])], [("zone", ogr.OFTString)])
        name = json.dumps(HOSTILE)
        self.scenario(f'[screens]\nfile = "screens.gpkg"\n[ground]\nfile = "ground.gpkg"\nfield = "zone"\n'
                      f"[ground.zones.{name}]\nEn50 = 0.2\n")
        done = self.run_well("check", self.path("s.toml"))
        self.assertIn("<script>", done.stdout)
        self.assert_tame(done.stdout + done.stderr)
        self.scenario(f'[screens]\nfile = "screens.gpkg"\n[ground]\nfile = "ground.gpkg"\nfield = "zone"\n'
                      f"[ground.zones.{name}]\nEn50 = 0.2\n".replace("trajectories = 2", "trajectories = 60"))
        done = self.run_well("run", self.path("s.toml"), "-o", self.path("out"))
        self.assert_tame(done.stdout + done.stderr)
        self.assertEqual(self.record()["screens"][0]["id"], HOSTILE)  # JSON says it all
        done = self.call("barrier", self.path("out"), "--screen", HOSTILE)
        self.assert_tame(done.stdout + done.stderr)
        for text in (f"{name} = 1\n", f"surface = {name}\n", f"[ground]\ndefault = {name}\n"):
            self.write("s.toml", text)
            done = self.call("check", self.path("s.toml"))
            self.assertEqual(done.returncode, 2)
            self.assertIn("\\x1b[31m\\u202e", done.stderr)
            self.assert_tame(done.stderr)
        done = self.call("run", self.path("nowhere\x1b[31m\u202e.toml"), "-o", self.path("o"))
        self.assert_tame(done.stderr)
        done = self.call("check", "--dem", b"\x9b31m.tif", "--sources", self.path("sources.gpkg"))
        self.assertIn("\\x9b31m", done.stderr)


if __name__ == "__main__":
    unittest.main()
