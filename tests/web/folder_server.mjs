// A folder as any web server shows it.
import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';

const types = { html: 'text/html', js: 'text/javascript', css: 'text/css', json: 'application/json' };

/// Serves `folder` below /maps/street/, which shows its index.html.
export async function serveFolder(folder) {
  const web = createServer(async (request, response) => {
    const path = new URL(request.url, 'http://localhost').pathname.replace(/^\/maps\/street\/$/,
      '/maps/street/index.html');
    try {
      const bytes = await readFile(join(folder, path.replace(/^\/maps\/street\//, '')));
      response.setHeader('Content-Type', types[path.split('.').pop()] ?? 'application/octet-stream');
      response.end(bytes);
    } catch {
      response.statusCode = 404;
      response.end();
    }
  });
  await new Promise((resolve) => { web.listen(0, '127.0.0.1', resolve); });
  return {
    url: `http://127.0.0.1:${web.address().port}/maps/street/`,
    stop: () => web.close(),
  };
}
