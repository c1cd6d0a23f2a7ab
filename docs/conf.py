"""Settings of the site: `make docs` builds it from this folder."""

import os
import re
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))
os.environ["MATPLOTLIBRC"] = str(HERE / "_static/matplotlibrc")   # for the notebooks' kernels, too

from _site import katex_at_hand  # noqa: E402

import polhode  # noqa: E402

# Notebooks and gallery run unless POLHODE_DOCS_RUN=0: then the pages show their code alone, as quick checks need it.
RUN = os.environ.get("POLHODE_DOCS_RUN", "1") != "0"

project, author, version = "polhode", "The polhode developers", polhode.__version__
copyright = "The polhode developers, BSD-3-Clause"
extensions = [
    "myst_nb", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "sphinx.ext.napoleon", "sphinx_gallery.gen_gallery",
    "sphinxcontrib.bibtex", "sphinxcontrib.katex", "sphinx_copybutton", "_site",
]
exclude_patterns = ["_static", "_site", "gallery/**", "auto_gallery/**.ipynb", "auto_gallery/**.py",
                    "auto_gallery/**.zip", "**/sg_execution_times.rst", "sg_execution_times.rst", "jupyter_execute"]
nitpicky = True
nitpick_ignore_regex = [("py:.*", r"(?!polhode\.).*"), ("py:class", r"polhode\.torques"), ("py:.*", r"polhode\._.*")]
suppress_warnings = ["config.cache"]

# Markdown, formulas, notebooks
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist", "attrs_inline"]
myst_heading_anchors = 4
myst_links_external_new_tab = False
nb_execution_mode = "cache" if RUN else "off"
nb_execution_timeout = 120
nb_execution_raise_on_error = True
nb_merge_streams = True
katex_prerender = katex_at_hand()
katex_css_path = "katex/katex.css"

# The API: docstrings in NumPy's style
default_role = "code"
autodoc_typehints = "none"
autosummary_generate = False
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": False}
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
napoleon_use_param = False   # types are prose: a cross-reference would take any word of them for a name

# The gallery
sphinx_gallery_conf = {
    "examples_dirs": str(HERE / "gallery"), "gallery_dirs": "auto_gallery", "filename_pattern": r"/\w+\.py",
    "plot_gallery": RUN, "within_subsection_order": "FileNameSortKey", "remove_config_comments": True,
    "download_all_examples": False, "show_signature": False, "write_computation_times": False,
    "show_memory": False, "min_reported_time": 1000, "reset_modules": ("_site.reset_matplotlib",),
    "abort_on_example_error": True, "image_srcset": ["2x"], "thumbnail_size": (640, 448), "nested_sections": False,
}

# The bibliography
bibtex_bibfiles = ["references.bib"]
bibtex_default_style = "keys"
bibtex_reference_style = "label"

# Looks
html_theme = "furo"
html_title = f"polhode {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_js_files = ["site.js"]
html_copy_source = False
html_show_sphinx = False
pygments_style = "friendly"
pygments_dark_style = "monokai"
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#0b5fa5", "color-brand-content": "#0b5fa5"},
    "dark_css_variables": {"color-brand-primary": "#6cb6ff", "color-brand-content": "#6cb6ff"},
}


def escape_bars(app, what, name, obj, options, lines):
    """Sizes as |r| are no substitutions."""
    lines[:] = [re.sub(r"\|(\w+)\|", r"\\|\1\\|", line) for line in lines]


def setup(app):
    app.connect("autodoc-process-docstring", escape_bars)
