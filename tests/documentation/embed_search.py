"""Makes the search of the site work from a disk, where browsers let pages neither start workers nor fetch an index. One
script, search/main.js, replaces the three of mkdocs: lunr.js, the index, and the script that searches it.

usage: embed_search.py SITE"""

import json
import pathlib
import sys

GLUE = """
;(function () {
  var documents = {};
  var index = lunr(function () {
    this.field('title');
    this.field('text');
    this.ref('location');
    for (var i = 0; i < search_data.docs.length; i++) {
      this.add(search_data.docs[i]);
      documents[search_data.docs[i].location] = search_data.docs[i];
    }
  });
  if (search_data.config.min_search_length)
    min_search_length = search_data.config.min_search_length - 1;
  window.searchWorker = {
    postMessage: function (message) {
      var found = [];
      try {
        found = index.search(message.query);
      } catch (error) { } // while a query such as "title:" is being written
      displayResults(found.map(function (one) {
        var page = documents[one.ref];
        return {location: page.location, title: page.title, summary: page.text.substring(0, 200)};
      }));
    }
  };
  initSearch();
})();
"""


def main(site):
    folder = site / "search"
    index = json.loads((folder / "search_index.json").read_text(encoding="utf-8"))
    ours = (folder / "main.js").read_text(encoding="utf-8")
    end = ours.index("if (!window.Worker) {\n  console.log")
    functions = ours[:end].replace("if (!window.Worker) {\n      displayResults(search(query));\n    } else {\n"
                                   "      searchWorker.postMessage({query: query});\n    }",
                                   "searchWorker.postMessage({query: query});")
    lunr = (folder / "lunr.js").read_text(encoding="utf-8")
    # "</" would end a script inside of a page.
    data = json.dumps({"config": index["config"], "docs": index["docs"]}).replace("</", "<\\/")
    (folder / "main.js").write_text(f"{lunr}\nvar min_search_length = 2, search_data = {data};\n{functions}{GLUE}",
                                    encoding="utf-8")
    print(f"the search knows {len(index['docs'])} sections")


main(pathlib.Path(sys.argv[1]))
